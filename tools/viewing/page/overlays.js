// Overlays and neighbours of the picture: a picture to compare with, false colours, and the samples of a pixel.
const comparing = { mode: '', share: 50, target: '', kept: null };

function showCompared() {
    compare(part('stack'), part('above'), comparing.mode, comparing.share);
    part('border').hidden = comparing.mode !== 'slide';
    const box = part('above').getBoundingClientRect(), frame = part('frame').getBoundingClientRect();
    part('border').style.left = box.left - frame.left + box.width * comparing.share / 100 + 'px';
    saySides();
    fadeOutline();
    for (const name of ['slide', 'flip', 'difference']) part(name).classList.toggle('on', comparing.mode === name);
}

// Says which picture is on which side of the wipe, or is shown.
function saySides() {
    const [left, right] = [part('side_left'), part('side_right')], other = part('with').selectedOptions[0]?.textContent ?? '';
    left.hidden = !comparing.mode;
    right.hidden = comparing.mode !== 'slide';
    [left.textContent, right.textContent] = comparing.mode === 'flip' && comparing.share < 50 ? [other, ''] : ['this picture', other];
    if (comparing.mode === 'difference') left.textContent = 'difference to ' + other + ', eight times';
    left.classList.toggle('beside', comparing.mode === 'slide');
    left.style.left = comparing.mode === 'slide' ? part('border').style.left : '';
    right.style.left = part('border').style.left;
}

// The meanings of the false colours, which false_colour.h defines.
const legends = {
    focus: [['#008000', 'sharp: a CoC below 1 px']],
    coc: [['#00f', 'in front of focus'], ['#fff', 'in focus'], ['#f00', 'behind it; half of the colour at a CoC of 8 px']],
    layers: [['#808080', '1 sample a pixel'], ['#00f', '2'], ['#0ff', '3'], ['#0f0', '4'], ['#ff0', '5'], ['#ff8000', '6'], ['#f00', '7'], ['#fff', 'more']],
    tiles: [['#000', 'copied'], ['#00f', '16 lens points'], ['#0f0', '256'], ['#f00', '4096']],
};

function sayLegend() {
    part('legend').hidden = !state.overlay;
    part('legend').replaceChildren(...(legends[state.overlay] ?? []).flatMap(([colour, text]) => {
        const swatch = document.createElement('i');
        swatch.style.background = colour;
        return [swatch, text + ' '];
    }));
}

// Choosing the active mode again ends it; flip shows the other picture first.
async function setComparing(mode) {
    if (mode === 'flip' && comparing.mode === 'flip' && comparing.share >= 50) comparing.share = 0;
    else if (mode === comparing.mode) [comparing.mode, comparing.share] = ['', 50];
    else [comparing.mode, comparing.share] = [mode, mode === 'flip' ? 0 : 50];
    await loadTarget();
    showCompared();
}

// Draws the picture to compare with, else the plate as the background. "As rendered" is taken by a lens without
// aperture.
async function loadTarget() {
    if (!comparing.mode && !state.facts.plate) return;
    comparing.target = comparing.mode ? part('with').value : 'plate';
    try {
        if (comparing.target === 'kept') {
            if (comparing.kept) draw(part('below'), comparing.kept);
            return;
        }
        const settings = { 'lens-radius': '0' };
        const response = ['reference', 'plate'].includes(comparing.target) ? await ask(comparing.target, { exposure: state.exposure })
            : await ask('rendered', { settings, exposure: state.exposure });
        if (response) draw(part('below'), (await pictureOf(response)).data);
    } catch (error) {
        say(error.message);
    }
}

function keep() {
    const above = part('above');
    comparing.kept = above.getContext('2d').getImageData(0, 0, above.width, above.height);
    if (!part('with').querySelector('[value=kept]')) part('with').append(new Option('what was kept', 'kept'));
    part('with').value = 'kept';
    loadTarget().then(showCompared);
}

function setOverlay(name) {
    state.overlay = state.overlay === name ? '' : name;
    sayLegend();
    fadeOutline();
    changed();
}

// Looks through one point of the lens, which the disc beside the picture shows.
function setEye(eye) {
    const far = eye ? Math.max(1, Math.hypot(...eye)) : 1;
    state.eye = eye && eye.map((along) => along / far);
    part('eye').classList.toggle('on', Boolean(state.eye));
    part('lens_disc').hidden = !state.eye;
    if (state.eye) {
        part('eye_at').style.left = 50 + 50 * state.eye[0] + '%';
        part('eye_at').style.top = 50 - 50 * state.eye[1] + '%';
    }
    changed();
}

const listed = { on: false, pixel: null, asking: false, again: null };

// Shows the value of the pixel under the pointer, and its samples if the list is open.
async function sayPixel(pixel) {
    if (listed.asking) {
        listed.again = pixel;
        return;
    }
    listed.asking = true;
    try {
        const said = await (await ask('samples', { settings: state.settings, pixel })).json();
        listed.pixel = pixel;
        const value = said.value ? ['R', 'G', 'B', 'A'].filter((name) => name in said.value)
            .map((name) => name + ' ' + asText(asNumber(said.value[name]), 4)).join('  ') : '';
        const front = said.samples[0], depth = front && asText(asNumber(front.z), 5);
        part('depth').textContent = depth ? 'depth ' + depth + ' ' + unit() : 'nothing';
        part('pixel').textContent = pixel.join(',') + '  ' + value + (front ? '  depth ' + depth + ' ' + unit() +
            '  CoC ' + asText(asNumber(front.coc), 3) + ' px' : '  nothing');
        part('object').textContent = front?.objects.length ? 'object ' + [...new Set(front.objects)].join(', ') : '';
        sayList(said.samples);
    } catch (error) {
        say(error.message);
    }
    listed.asking = false;
    if (listed.again) {
        const next = listed.again;
        listed.again = null;
        sayPixel(next);
    }
}

function sayList(samples) {
    part('samples').hidden = !listed.on;
    if (!listed.on) return;
    const table = document.createElement('table'), row = (cells, tag) => {
        const line = document.createElement('tr');
        for (const text of cells) {
            const cell = document.createElement(tag);
            cell.textContent = text;
            line.append(cell);
        }
        return line;
    };
    const head = table.createTHead(), body = table.createTBody();
    head.append(row(['pixel ' + listed.pixel.join(','), 'depth, ' + unit(), 'image at', 'CoC, px', 'alpha', 'colour', 'objects'], 'th'));
    samples.forEach((sample, i) => {
        const colour = sample.rgb.map((value) => asText(asNumber(value), 3)).join(' ');
        const line = row([i + 1, asText(asNumber(sample.z), 5), sample.image === undefined ? '' : asText(asNumber(sample.image), 5),
            asText(asNumber(sample.coc), 3), asText(sample.alpha, 3), colour, sample.objects.join(' ')], 'td');
        const at = sample.image ?? sample.z;
        line.title = 'click: focus here';
        line.classList.toggle('in_focus', asNumber(at) === focusNow());
        line.addEventListener('click', () => set('focus-distance', at));
        body.append(line);
    });
    part('samples').replaceChildren(table);
}

function setList(on) {
    listed.on = on;
    part('list').classList.toggle('on', on);
    part('samples').hidden = !on;
    if (on && listed.pixel) sayPixel(listed.pixel);
}

function startOverlays() {
    if (state.facts.reference) part('with').append(new Option('the reference', 'reference'));
    part('with').append(new Option('the picture as rendered', 'rendered'));
    part('with').addEventListener('change', () => loadTarget().then(showCompared));
    part('keep').addEventListener('click', keep);
    for (const mode of ['slide', 'flip', 'difference']) part(mode).addEventListener('click', () => setComparing(mode));
    for (const name of ['focus', 'coc', 'layers', 'tiles']) part('show_' + name).addEventListener('click', () => setOverlay(name));
    part('eye').hidden = !state.facts.lens_method;
    part('eye').addEventListener('click', () => setEye(state.eye ? null : [0, 0]));
    part('list').addEventListener('click', () => setList(!listed.on));
    part('border').addEventListener('pointerdown', (event) => part('border').setPointerCapture(event.pointerId));
    part('border').addEventListener('pointermove', (event) => {
        if (!event.buttons) return;
        const box = part('above').getBoundingClientRect();
        comparing.share = Math.min(100, Math.max(0, 100 * (event.clientX - box.left) / box.width));
        showCompared();
    });
}

// Objects from the file's Cryptomattes: the one under the pointer is outlined and named, and a lens can be found for
// it.
const objects = { list: null, numbers: null, asked: false, shown: 0, fade: 0 };

async function loadObjects() {
    if (objects.asked || !state.facts.objects) return;
    objects.asked = true;
    const { said, bytes } = await apart(await ask('objects', {}));
    objects.list = said.objects;
    objects.numbers = new Uint16Array(bytes.slice().buffer);
}

function forgetObjects() {
    outline(0);
    [objects.list, objects.numbers, objects.asked] = [null, null, false];
}

// The number of the object at a pixel, 0 for none.
function objectAt([x, y]) {
    const { width, min } = state.facts;
    return objects.numbers ? objects.numbers[(y - min[1]) * width + x - min[0]] : 0;
}

// Marks the pixels of the object that have a neighbour outside it.
function outline(number) {
    if (number === objects.shown) return;
    objects.shown = number;
    const { width, height } = state.facts, data = new ImageData(width, height), of = objects.numbers;
    for (let y = 0, i = 0; number && y < height; ++y)
        for (let x = 0; x < width; ++x, ++i)
            if (of[i] === number && (x > 0 && of[i - 1] !== number || x + 1 < width && of[i + 1] !== number ||
                y > 0 && of[i - width] !== number || y + 1 < height && of[i + width] !== number))
                data.data.set([255, 210, 60, 255], 4 * i);
    draw(part('marks'), data);
}

// Shows the outline while the pointer moves, but not in comparisons and false colours.
function fadeOutline() {
    const marks = part('marks');
    clearTimeout(objects.fade);
    marks.classList.toggle('still', Boolean(comparing.mode || state.overlay));
    objects.fade = setTimeout(() => marks.classList.add('still'), 1000);
}

// Sets focus and aperture so that the whole object is sharp; the aperture never becomes wider than now.
function sharpen(pixel) {
    const object = objects.list?.[objectAt(pixel) - 1];
    if (!object) return false;
    const by = Math.max(1, asNumber(state.lens.hyperfocal) / asNumber(object.hyperfocal));
    state.settings['focus-distance'] = String(object.focus);
    set(aperture(), asText(aperture() === 'fstop' ? apertureNow() * by : apertureNow() / by, 4));
    return true;
}
