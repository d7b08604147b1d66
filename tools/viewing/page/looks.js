// The looks of the lens: presets, numbers, and the few that are neither.
function lookRow(name, help, ...controls) {
    const row = document.createElement('label'), text = document.createElement('span');
    row.className = 'row look';
    row.title = help;
    text.textContent = name;
    row.append(text, ...controls);
    part('looks').append(row);
    return row;
}

// A choice of words, of which the first means what the file or the command line says.
function addChoice(option, help, first, words) {
    const select = document.createElement('select');
    select.id = 'look_' + option;
    select.append(new Option(first, ''), ...words.map((word) => new Option(word, word)));
    select.addEventListener('change', () => set(option, select.value));
    lookRow(option, help, select).addEventListener('begin', () => select.value = '');
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
        const begin = () => {
            text.value = '';
            slider.value = text.placeholder;
        };
        begin();
        lookRow(look.name, look.help, slider, text).addEventListener('begin', begin);
        slider.addEventListener('input', () => {
            const value = look.name === 'blades' && slider.value < 3 ? '0' : slider.value;
            set(look.name, text.value = value);
        });
        text.addEventListener('change', () => {
            slider.value = text.value || text.placeholder;
            set(look.name, text.value.trim());
        });
    }
}

// Two angles, which are one option.
function addTilt() {
    const fields = ['X', 'Y'].map((axis) => {
        const field = document.createElement('input');
        field.placeholder = axis + ' 0';
        field.id = 'tilt_' + axis;
        field.addEventListener('change', () => set('tilt', fields.some((f) => f.value.trim()) ?
            fields.map((f) => f.value.trim() || '0').join(',') : ''));
        return field;
    });
    lookRow('tilt', 'Angles of the plane of focus in degrees: above 0 it is nearer to the right (X) and at the top (Y)', ...fields)
        .addEventListener('begin', () => fields.forEach((field) => field.value = ''));
}

function addLooks() {
    if (state.facts.lenses) addChoice('lens', 'A lens by name; the numbers below beat what it says', 'none', state.facts.lenses);
    addNumbers();
    addTilt();
    addChoice('axial-chromatic-type', 'Colours that focus off the green plane', 'as it began', state.facts.chromatic_types);
    addChoice('cat-eye-darkening', "Darken where the cat's eye blocks light", 'as it began', ['on']);
}

function resetLooks() {
    for (const row of part('looks').querySelectorAll('.look')) row.dispatchEvent(new Event('begin'));
}
