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
