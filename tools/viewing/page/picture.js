// The picture: while settings change, the finest drafts that allow ten a second; then the whole picture.
const drafts = [[1, 'normal', 3], ...[1, 2, 3, 4, 6, 8, 12, 16].map((proxy) => [proxy, 'draft', 1 / proxy ** 2])]; // [proxy, quality, work]
const state = {
    facts: null,
    settings: {},    // options of dof-gather that this page has set
    quality: 'normal', // of the last whole picture requested
    exposure: 0,
    eye: null,       // the lens point that is looked through: [right, up] from its middle, 1 at the rim; null: all
    overlay: '',     // the value of --show: false colours instead of the picture
    lens: null,      // what the server reports of the last picture's lens
    began: undefined, // the aperture of the first picture
};
const flow = { level: 4, drafting: false, again: false, full: 0, rest: 0, slow: 0, reshow: false, reshowing: false, pointer: null, pieces: 0 };

// The settings that make the picture, without those of drafts.
function settingsNow() {
    const settings = { ...state.settings };
    if (state.overlay) settings.show = state.overlay;
    else if (state.eye) settings['lens-point'] = state.eye.map((part) => part.toFixed(3)).join(',');
    return settings;
}

function withQuality(settings, quality) {
    return state.facts.lens_method ? { ...settings, quality } : settings;
}

function exposureNow() {
    return state.overlay ? 0 : state.exposure;
}

function draw(canvas, data) {
    canvas.width = data.width;
    canvas.height = data.height;
    canvas.style.width = state.facts.width * state.facts.pixel_aspect + 'px';
    canvas.style.height = state.facts.height + 'px';
    canvas.getContext('2d').putImageData(data, 0, 0);
}

// Shows the answer, if there is one, the time that it took, and the device that gathered it. `what`: the name of the picture.
async function show(response, quality, begun, what = quality) {
    if (!response) return null;
    const { said, data } = await pictureOf(response);
    draw(part('above'), data);
    state.lens = said.lens;
    for (const each of ['normal', 'final']) part(each).classList.toggle('on', quality === each);
    part('quality').textContent = quality === 'draft' ? 'a draft' : '';
    document.body.dataset.quality = quality;
    part('speed').textContent = what + ': ' + Math.round(performance.now() - begun) + ' ms' + (said.device ? ', ' + said.device : '');
    sayLens();
    return said;
}

// Chooses finer drafts if there is time, coarser ones if not.
function choose(milliseconds) {
    const aim = 100, finer = drafts[flow.level - 1];
    if (milliseconds > aim && flow.level + 1 < drafts.length) ++flow.level;
    else if (finer && milliseconds * finer[2] / drafts[flow.level][2] < 0.8 * aim) --flow.level;
}

// Handles a changed setting: makes drafts, then the whole picture.
async function changed() {
    clearTimeout(flow.rest);
    say('');
    sayControls();
    if (flow.drafting) {
        flow.again = true;
        return;
    }
    flow.drafting = true;
    try {
        do {
            flow.again = false;
            await draft();
        } while (flow.again);
    } catch (error) {
        say(error.message);
    }
    flow.drafting = false;
    clearTimeout(flow.rest);
    flow.rest = setTimeout(() => full('normal'), 150);
}

async function draft() {
    await knowFrame();
    if (state.overlay) return; // false colours describe the full-size pixels
    const begun = performance.now(), [proxy, quality] = drafts[flow.level];
    const settings = withQuality(proxy > 1 ? { ...settingsNow(), proxy: String(proxy) } : settingsNow(), quality);
    const response = await ask('picture', { settings, exposure: exposureNow() });
    if (!await show(response, 'draft', begun, proxy > 1 ? 'draft at 1/' + proxy : quality)) return;
    choose(performance.now() - begun);
    await new Promise(requestAnimationFrame); // until the draft is on screen
}

// Makes the whole picture. A newer change of settings ends the request.
async function full(quality) {
    const turn = ++flow.full, begun = performance.now();
    state.quality = quality;
    remember();
    sayCommand().catch(() => {}); // the picture reports errors
    flow.slow = setTimeout(() => watch(turn), 500);
    showPieces(turn).catch(() => {});
    try {
        await knowFrame();
        const asked = { settings: withQuality(settingsNow(), quality), exposure: exposureNow(), pixel: flow.pointer ?? middle() };
        const said = await show(await ask('picture', asked), quality, begun);
        if (said) knowMore().catch((error) => say(error.message));
    } catch (error) {
        say(error.message);
    }
    if (turn === flow.full) {
        clearTimeout(flow.slow);
        part('busy').hidden = true;
        ++flow.full;
    }
}

function middle() {
    const { min, width, height } = state.facts;
    return [min[0] + (width >> 1), min[1] + (height >> 1)];
}

// Draws tiles of the picture over the draft as they are made.
async function showPieces(turn) {
    const canvas = part('above'), { min, width, height } = state.facts;
    for (;;) {
        await new Promise((wake) => setTimeout(wake, 100));
        if (turn !== flow.full) return;
        const { said, bytes } = await apart(await ask('pieces', {}));
        if (turn !== flow.full || flow.drafting) return;
        let from = 0;
        for (const piece of said.pieces) {
            if (canvas.width !== width || canvas.height !== height) enlarge(canvas, width, height);
            const size = piece.width * piece.height * piece.channels;
            canvas.getContext('2d').putImageData(imageOf(piece, bytes.subarray(from, from + size)), piece.x - min[0], piece.y - min[1]);
            from += size;
            ++flow.pieces;
        }
    }
}

function enlarge(canvas, width, height) {
    const before = document.createElement('canvas');
    [before.width, before.height] = [canvas.width, canvas.height];
    before.getContext('2d').drawImage(canvas, 0, 0);
    [canvas.width, canvas.height] = [width, height];
    canvas.getContext('2d').drawImage(before, 0, 0, width, height);
}

// Shows the same picture at another exposure.
async function reshow() {
    flow.reshow = true;
    if (flow.reshowing) return;
    flow.reshowing = true;
    while (flow.reshow) {
        flow.reshow = false;
        await full(state.quality);
    }
    flow.reshowing = false;
}

// Shows the progress of the picture.
async function watch(turn) {
    while (turn === flow.full) {
        const said = await (await ask('progress', {})).json();
        part('busy').hidden = turn !== flow.full || said.percent === undefined;
        part('done').style.width = (said.percent || 0) + '%';
        await new Promise((wake) => setTimeout(wake, 200));
    }
}
