// Hands: the pointer on the picture, and the keyboard.
const place = { zoom: 1, x: 0, y: 0, fitted: true };

function showPlace() {
    part('stack').style.transform = 'translate(' + place.x + 'px,' + place.y + 'px) scale(' + place.zoom + ')';
    part('stack').classList.toggle('far', place.zoom < 2);
    showRegion();
    showCompared();
}

function fit() {
    const frame = part('frame').getBoundingClientRect(), width = state.facts.width * state.facts.pixel_aspect, height = state.facts.height;
    place.zoom = Math.min(frame.width / width, frame.height / height);
    place.x = (frame.width - width * place.zoom) / 2;
    place.y = (frame.height - height * place.zoom) / 2;
    place.fitted = true;
    showPlace();
}

// Zooms about (x, y) in the window; about the middle if no point is given.
function zoomBy(factor, x, y) {
    const frame = part('frame').getBoundingClientRect();
    const at = { x: (x ?? frame.left + frame.width / 2) - frame.left, y: (y ?? frame.top + frame.height / 2) - frame.top };
    const zoom = Math.min(64, Math.max(0.05, place.zoom * factor)), by = zoom / place.zoom;
    place.x = at.x - (at.x - place.x) * by;
    place.y = at.y - (at.y - place.y) * by;
    place.zoom = zoom;
    place.fitted = false;
    showPlace();
}

function pan(x, y) {
    place.x += x;
    place.y += y;
    place.fitted = false;
    showPlace();
}

// Pixels right and down of the first pixel of the picture to the pointer, also beside the picture.
function placeOf(event) {
    const frame = part('frame').getBoundingClientRect();
    return [Math.floor((event.clientX - frame.left - place.x) / place.zoom / state.facts.pixel_aspect),
        Math.floor((event.clientY - frame.top - place.y) / place.zoom)];
}

// The pixel of the picture under the pointer, in EXR coordinates; null beside the picture.
function pixelAt(event) {
    const { width, height, min } = state.facts, [x, y] = placeOf(event);
    return x < 0 || y < 0 || x >= width || y >= height ? null : [x + min[0], y + min[1]];
}

async function focusAt(pixel, wantsObject = false) {
    const { samples } = await (await ask('samples', { settings: state.settings, pixel })).json();
    if (samples.length === 0) return say('there is nothing to focus on in pixel ' + pixel.join(','));
    set('focus-distance', samples[0].z);
    if (wantsObject) say('focused, but not stopped down: ' + (state.facts.objects ? 'no Cryptomatte names the object there' : 'the file has no Cryptomattes, which name the objects'), true);
}

const moveFocus = (steps) => set('focus-distance', asText(Math.min(focusNow(), 1e6) * 1.01 ** steps, 5));
const moveAperture = (stops) => {
    const by = aperture() === 'fstop' ? 2 ** (stops / 2) : 2 ** (-stops / 2);
    set(aperture(), asText(Math.min(apertureNow(), 1e4) * by, 4));
};

// Shows the depth beside the pointer, because what is out of focus may be too blurred to be recognised.
function moveDepth(event, shown) {
    const frame = part('frame').getBoundingClientRect();
    part('depth').hidden = !shown;
    part('depth').style.left = event.clientX - frame.left + 'px';
    part('depth').classList.toggle('before', event.clientX > frame.right - 150);
    part('depth').style.top = event.clientY - frame.top + 'px';
}

function startPointer() {
    const frame = part('frame');
    let pressed = null;
    frame.addEventListener('pointerdown', (event) => {
        if (event.target.closest('#samples, #border')) return;
        part('hint').hidden = true;
        frame.setPointerCapture(event.pointerId);
        frame.focus();
        pressed = {
            x: event.clientX, y: event.clientY, lastX: event.clientX, lastY: event.clientY, moved: false,
            from: apertureNow(), eye: state.eye,
        };
    });
    frame.addEventListener('pointermove', (event) => {
        const pixel = flow.pointer = pixelAt(event);
        moveDepth(event, pixel && !pressed);
        if (!pressed) {
            if (pixel && !event.target.closest('#samples')) sayPixel(pixel);
            if (objects.list) outline(pixel ? objectAt(pixel) : 0);
            fadeOutline();
            return;
        }
        if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > 3) pressed.moved = true;
        if (!pressed.moved) return;
        if (event.shiftKey || event.buttons & 4) pan(event.clientX - pressed.lastX, event.clientY - pressed.lastY);
        else if (pressed.eye) setEye([pressed.eye[0] + (event.clientX - pressed.x) / 100, pressed.eye[1] - (event.clientY - pressed.y) / 100]);
        else {
            const stops = (event.clientX - pressed.x) / 60, by = 2 ** (stops / 2);
            set(aperture(), asText(aperture() === 'fstop' ? pressed.from * by : pressed.from / by, 3));
        }
        [pressed.lastX, pressed.lastY] = [event.clientX, event.clientY];
    });
    frame.addEventListener('pointerup', (event) => {
        const clicked = pressed && !pressed.moved && event.button === 0, pixel = pixelAt(event);
        pressed = null;
        if (!clicked || !pixel) return;
        if (event.altKey) {
            listed.pixel = pixel;
            setList(true);
        } else if (!event.shiftKey || !sharpen(pixel)) focusAt(pixel, event.shiftKey).catch((error) => say(error.message));
    });
    frame.addEventListener('pointerleave', () => part('depth').hidden = true);
    frame.addEventListener('pointercancel', () => pressed = null);
    frame.addEventListener('wheel', (event) => {
        if (event.target.closest('#samples')) return;
        event.preventDefault();
        const notches = -event.deltaY / (event.deltaMode === 0 ? 100 : 3);
        if (event.ctrlKey) zoomBy(1.25 ** notches, event.clientX, event.clientY);
        else moveFocus(2 * notches);
    }, { passive: false });
    new ResizeObserver(() => place.fitted ? fit() : showPlace()).observe(frame); // of the window, or of the panel
}

const keys = {
    w: ['wipe', () => setComparing('slide')],
    f: ['flip', () => setComparing('flip')],
    d: ['difference, eight times', () => setComparing('difference')],
    s: ['keep this picture to compare with', keep],
    p: ['peaking: what is sharp', () => setOverlay('focus')],
    c: ['circle of confusion: blue in front of focus, red behind', () => setOverlay('coc')],
    l: ['layers: samples a pixel', () => setOverlay('layers')],
    t: ['tiles: lens points', () => setOverlay('tiles')],
    e: ['the eye at one point of the lens: drag moves it', () => part('eye').click()],
    x: ['the samples of the pixel', () => setList(!listed.on)],
    r: ['draw the rectangle that match compares', () => part('rectangle').click()],
    m: ['match: the lens of the plate', () => part('match').click()],
    k: ['set a key at this frame', setKey],
    h: ['hide or show the panel', () => part('panel').click()],
    ',': ['the frame before', () => step(-1)],
    '.': ['the next frame', () => step(1)],
    ' ': ['plays the frames', play],
    y: ['copy the command line', () => copy('shell')],
    Enter: ['final quality', () => full('final')],
    ArrowUp: ['focus farther', () => moveFocus(1)],
    ArrowDown: ['focus nearer', () => moveFocus(-1)],
    ArrowLeft: ['open up by a third of a stop', () => moveAperture(-1 / 3)],
    ArrowRight: ['stop down by a third', () => moveAperture(1 / 3)],
    '[': ['darker by a quarter of a stop', () => setExposure(state.exposure - 0.25)],
    ']': ['brighter', () => setExposure(state.exposure + 0.25)],
    '+': ['nearer', () => zoomBy(1.25)],
    '-': ['farther', () => zoomBy(0.8)],
    '0': ['all of the picture', fit],
    '1': ['a pixel is a pixel', () => zoomBy(1 / place.zoom)],
};

function startKeys() {
    addEventListener('keydown', (event) => {
        if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z' && !event.target.writing) {
            event.preventDefault();
            undo(event.shiftKey ? 1 : -1);
        }
        const typing = event.target.matches('input:not([type=range], [type=checkbox]), select, textarea') && event.key !== 'Escape';
        const pressing = event.target.matches('button, summary, [type=checkbox]') && [' ', 'Enter'].includes(event.key);
        const moving = event.target.matches('[type=range]') && event.key.startsWith('Arrow');
        if (event.ctrlKey || event.metaKey || event.altKey || typing || pressing || moving) return;
        if (event.key === 'Escape') part('frame').focus();
        const found = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (!found) return;
        event.preventDefault();
        found[1]();
    });
    const gestures = [['click', 'focus there'], ['Alt and click', 'the samples there; click one to focus on it'],
        ['Shift and click', 'stops down until all of the object is sharp'], ['drag sideways', 'f-number'], ['wheel', 'focus'], ['Ctrl and wheel', 'zoom'], ['Shift and drag', 'move the picture'], ['Ctrl and Z', 'undo; with Shift: redo'],
        ...Object.entries(keys).map(([key, [what]]) => [key === ' ' ? 'Space' : key.length === 1 ? key.toUpperCase() : key, what])];
    for (const line of gestures) {
        const row = part('help').insertRow();
        for (const text of line) row.insertCell().textContent = text;
    }
}
