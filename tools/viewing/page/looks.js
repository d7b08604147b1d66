// The looks of the lens: a control for each that the server lists. Each row can show its current setting.
const rows = [];

function lookRow(look, show, ...controls) {
    const row = document.createElement('label'), text = document.createElement('span');
    row.className = 'row look';
    row.dataset.option = look.name;
    row.title = look.help + ' (--' + look.name + ')';
    text.textContent = look.label;
    row.append(text, ...controls);
    part('looks').append(row);
    rows.push(show);
}

// The first word means the value from the file or the command line.
function addChoice(look) {
    const select = document.createElement('select');
    select.id = 'look_' + look.name;
    select.append(new Option('as given', ''), ...look.words.map((word) => new Option(word, word)));
    select.addEventListener('change', () => set(look.name, select.value));
    lookRow(look, () => select.value = state.settings[look.name] ?? '', select);
}

function addNumber(look) {
    const slider = document.createElement('input'), text = document.createElement('input');
    slider.type = 'range';
    [slider.min, slider.max] = [look.low, look.high];
    slider.step = look.whole_from ? 1 : (look.high - look.low) / 100;
    text.id = 'look_' + look.name;
    text.placeholder = look.usual;
    lookRow(look, () => {
        fillField(text, state.settings[look.name] ?? '');
        slider.value = state.settings[look.name] ?? look.usual;
    }, slider, text);
    slider.addEventListener('input', () => set(look.name, look.whole_from && slider.value < look.whole_from ? look.low : slider.value));
    startField(text, (value) => typed(look.name, value, text));
}

function addPair(look) {
    const fields = ['X', 'Y'].map((axis) => {
        const field = document.createElement('input');
        field.placeholder = axis + ' 0';
        field.id = look.name + '_' + axis;
        startField(field, () => typed(look.name, fields.some((f) => f.value.trim()) ? fields.map((f) => f.value.trim() || '0').join(',') : '', field));
        return field;
    });
    lookRow(look, () => fields.forEach((field, i) => fillField(field, state.settings[look.name]?.split(',')[i] ?? '')), ...fields);
}

function addLooks() {
    const adders = { choice: addChoice, number: addNumber, pair: addPair };
    for (const look of state.facts.looks) adders[look.control](look);
}

function showLooks() {
    for (const show of rows) show();
}
