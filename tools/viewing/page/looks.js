// The looks of the lens: presets, numbers, and a few other controls. Each row can show its current setting.
const rows = [];

// The photographer's name of each look; the row's title names the option.
const lookWords = {
    'blade-curvature': 'blade roundness', 'blade-rotation': 'blade rotation, \u00b0', squeeze: 'anamorphic squeeze', spherical: 'soap bubbles',
    'cat-eye': "cat's eye", 'cat-eye-darkening': "cat's eye darkens", 'axial-chromatic': 'colour fringes, mm', 'axial-chromatic-type': 'fringe colours',
    'field-curvature': 'curved focus', breathing: 'focus breathing', tilt: 'tilted focus, \u00b0', 'highlight-gain': 'brighter lights',
    'highlight-threshold': 'lights: above', 'highlight-knee': 'lights: softness', lens: 'lens by name',
};

function lookRow(option, help, show, ...controls) {
    const row = document.createElement('label'), text = document.createElement('span');
    row.className = 'row look';
    row.dataset.option = option;
    row.title = help + ' (--' + option + ')';
    text.textContent = lookWords[option] ?? option.replaceAll('-', ' ');
    row.append(text, ...controls);
    part('looks').append(row);
    rows.push(show);
}

// Adds a choice of words; the first one means the value from the file or the command line.
function addChoice(option, help, first, words) {
    const select = document.createElement('select');
    select.id = 'look_' + option;
    select.append(new Option(first, ''), ...words.map((word) => new Option(word, word)));
    select.addEventListener('change', () => set(option, select.value));
    lookRow(option, help, () => select.value = state.settings[option] ?? '', select);
}

// A control for each look that is a number, with the range that its words say.
function addNumbers() {
    for (const look of state.facts.looks) {
        const bounds = look.range.match(/-?[0-9.]+/g)?.map(Number).slice(-2) ?? [];
        let [low, high] = bounds.length === 2 ? bounds : look.unit === 'DEG' ? [-180, 180] : [0, 20];
        if (look.name === 'blades') low = 0;
        if (high > 20 && look.unit !== 'DEG') high = look.name === 'squeeze' ? 4 : look.name === 'highlight-gain' ? 50 : 3;
        const slider = document.createElement('input'), text = document.createElement('input');
        slider.type = 'range';
        [slider.min, slider.max] = [low, high];
        slider.step = look.name === 'blades' ? 1 : (high - low) / 100;
        text.id = 'look_' + look.name;
        text.placeholder = look.help.match(/default: ([^)]*)/)?.[1] ?? '';
        lookRow(look.name, look.help, () => {
            fillField(text, state.settings[look.name] ?? '');
            slider.value = state.settings[look.name] ?? text.placeholder;
        }, slider, text);
        slider.addEventListener('input', () => set(look.name, look.name === 'blades' && slider.value < 3 ? '0' : slider.value));
        startField(text, (value) => typed(look.name, value, text));
    }
}

// Adds two angles that form one option.
function addTilt() {
    const fields = ['X', 'Y'].map((axis) => {
        const field = document.createElement('input');
        field.placeholder = axis + ' 0';
        field.id = 'tilt_' + axis;
        startField(field, () => typed('tilt', fields.some((f) => f.value.trim()) ? fields.map((f) => f.value.trim() || '0').join(',') : '', field));
        return field;
    });
    lookRow('tilt', 'Angles of the plane of focus in degrees: above 0 it is nearer to the right (X) and at the top (Y)',
        () => fields.forEach((field, i) => fillField(field, state.settings.tilt?.split(',')[i] ?? '')), ...fields);
}

function addLooks() {
    if (state.facts.lenses) addChoice('lens', 'A lens by name; the numbers below beat what it says', 'none', state.facts.lenses);
    addNumbers();
    addTilt();
    addChoice('axial-chromatic-type', 'Colours that focus off the green plane', 'as given', state.facts.chromatic_types);
    addChoice('cat-eye-darkening', "Darken where the cat's eye blocks light", 'as given', ['on']);
}

function showLooks() {
    for (const show of rows) show();
}
