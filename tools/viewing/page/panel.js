// The panel beside the picture: the facts about the lens, and the controls that set it.
const aperture = () => state.facts.blur !== undefined ? 'blur' : state.facts.fstop === undefined ? 'lens-radius' : 'fstop';
const focusNow = () => asNumber(state.settings['focus-distance'] ?? state.lens?.focus ?? state.facts.focus);
const apertureNow = () => asNumber(state.settings[aperture()] ?? (aperture() === 'lens-radius' ? state.lens?.radius : state.facts[aperture()]));

// Sets the typed value if the server accepts it; else the old value stays.
async function typed(option, text, field) {
    try {
        await ask('commands', { settings: { ...state.settings, [option]: text } });
    } catch (error) {
        field.classList.add('wrong');
        return say(error.message);
    }
    field.classList.remove('wrong');
    set(option, text);
}

// Shows the text in a field unless the user is writing in it.
function fillField(field, text) {
    if (document.activeElement === field && field.writing) return;
    field.value = text;
    field.classList.remove('wrong');
}

function startField(field, change) {
    field.addEventListener('input', () => field.writing = true);
    field.addEventListener('change', () => {
        field.writing = false;
        change(field.value.trim());
    });
}

function set(option, value) {
    if (value === '') delete state.settings[option];
    else state.settings[option] = String(value);
    changed();
}

// Sliders are logarithmic, because focus and aperture can have any size.
function range(id) {
    const near = asNumber(state.facts.nearest) / 2, far = asNumber(state.facts.farthest);
    if (id === 'focus') return [near, Math.max(Number.isFinite(far) ? far * 1.2 : near * 1e4, near * 10)];
    const began = state.began;
    return aperture() === 'fstop' ? [Math.min(began, 1) / 4, Math.max(began * 32, 32)] : [began / 64, began * 4];
}
const toSlider = (value, [low, high]) => 1000 * Math.log(value / low) / Math.log(high / low);
const fromSlider = (place, [low, high]) => low * (high / low) ** (place / 1000);

function sayLens() {
    const lens = state.lens, number = (name) => asText(asNumber(lens[name]), 4);
    part('lens').textContent = 'sharp from ' + number('near') + ' to ' + number('far') + ' ' + unit() + '; hyperfocal distance ' +
        number('hyperfocal') + ' ' + unit() + '; largest CoC ' + asText(asNumber(lens.largest_coc), 3) + ' px';
    part('warning').textContent = lens.warnings.join('\n');
    if (state.began === undefined) state.began = apertureNow();
    sayControls();
}

function sayControls() {
    const fill = (id, value) => {
        fillField(part(id + '_text'), asText(value, 5));
        if (state.began > 0 && value > 0) part(id).value = toSlider(Math.min(value, 1e9), range(id));
    };
    fill('focus', focusNow());
    fill('aperture', apertureNow());
    part('focus_name').textContent = 'focus, ' + unit();
    part('aperture_name').textContent = { fstop: 'f-number', blur: 'blur, px' }[aperture()] ?? 'radius, ' + unit();
    showLooks();
    part('exposure').value = state.exposure;
    part('exposure_text').textContent = (state.exposure > 0 ? '+' : '') + state.exposure;
    for (const name of ['focus', 'coc', 'layers', 'tiles']) part('show_' + name).classList.toggle('on', state.overlay === name);
}

// The commands, by language.
async function commandsNow() {
    return (await ask('commands', { settings: withQuality(settingsNow(), state.quality), format: part('format').value })).json();
}

async function sayCommand() {
    part('command').value = (await commandsNow()).shell;
}

async function copyText(text) {
    part('command').value = text;
    part('command').select();
    let copied = true;
    try {
        await navigator.clipboard.writeText(text);
    } catch { // the browser does not allow it
        copied = document.execCommand('copy');
    }
    part('command').blur();
    part('copied').textContent = copied ? 'is copied' : 'cannot be copied by this browser: mark it';
    setTimeout(() => part('copied').textContent = '', 3000);
}

async function copy(language) {
    await copyText((await commandsNow())[language]);
}

function startPanel() {
    part('name').textContent = state.facts.file;
    part('guess').textContent = state.facts.guess ?? '';
    for (const [id, option] of [['focus', 'focus-distance'], ['aperture', aperture()]]) {
        part(id).addEventListener('input', () => set(option, asText(fromSlider(part(id).value, range(id)), 4)));
        startField(part(id + '_text'), (text) => typed(option, text, part(id + '_text')));
    }
    part('exposure').addEventListener('input', () => setExposure(Number(part('exposure').value)));
    part('normal').addEventListener('click', () => full('normal'));
    part('final').addEventListener('click', () => full('final'));
    part('copy_shell').addEventListener('click', () => copy('shell'));
    part('copy_python').addEventListener('click', () => copy('python'));
    part('reset').addEventListener('click', () => {
        state.settings = {};
        changed();
    });
    part('save').hidden = !state.facts.save;
    part('save').addEventListener('click', async () => {
        const response = await ask('save', { settings: withQuality(settingsNow(), 'final') });
        if (response) say('written: ' + (await response.json()).file, true);
    });
    part('format').addEventListener('change', () => {
        remember();
        sayCommand().catch((error) => say(error.message));
    });
    part('panel').addEventListener('click', () => document.body.classList.toggle('bare'));
    addLooks();
}

function setExposure(stops) {
    state.exposure = stops;
    sayControls();
    loadTarget();
    reshow();
}

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
