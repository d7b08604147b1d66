// The filmed plate: it lies behind the picture, and has the lens that "match" finds in a rectangle (dof-match).
const plate = { drawing: false, from: null, region: null }; // region: left, top, right, bottom, the last ones included

function showRegion() {
    const box = part('region'), of = plate.region, { min, pixel_aspect } = state.facts;
    box.hidden = !of;
    if (!of) return;
    box.style.left = place.x + (of[0] - min[0]) * pixel_aspect * place.zoom + 'px';
    box.style.top = place.y + (of[1] - min[1]) * place.zoom + 'px';
    box.style.width = (of[2] + 1 - of[0]) * pixel_aspect * place.zoom + 'px';
    box.style.height = (of[3] + 1 - of[1]) * place.zoom + 'px';
}

function setDrawing(on) {
    plate.drawing = on;
    plate.from = null;
    part('rectangle').classList.toggle('on', on);
}

// Draws the rectangle instead of what a drag does otherwise. A click alone removes it.
function drawRegion(event) {
    if (!plate.drawing || event.type !== 'pointerdown' && !plate.from) return;
    event.stopImmediatePropagation();
    const { min, width, height } = state.facts, [x, y] = placeOf(event);
    const at = [Math.min(Math.max(x, 0), width - 1) + min[0], Math.min(Math.max(y, 0), height - 1) + min[1]];
    if (event.type === 'pointerdown') {
        plate.from = at;
        part('frame').setPointerCapture(event.pointerId);
    }
    const ends = [0, 1].map((i) => [plate.from[i], at[i]].sort((a, b) => a - b));
    plate.region = at.join() === plate.from.join() ? null : [ends[0][0], ends[1][0], ends[0][1], ends[1][1]];
    showRegion();
    if (event.type === 'pointerup') setDrawing(false);
}

// Sets focus and f-number as the plate has them.
async function match() {
    part('match').disabled = true;
    say('matching ...', true);
    try {
        const response = await ask('match', { settings: state.settings, ...(plate.region && { region: plate.region }) });
        if (response) takeLens(await response.json());
    } catch (error) {
        say(error.message);
    }
    part('match').disabled = false;
}

function takeLens(lens) {
    const focus = lens.focus_distance, size = lens[aperture() === 'fstop' ? 'fstop' : 'lens_radius'];
    state.settings['focus-distance'] = asText(asNumber(focus.value), 5);
    state.settings[aperture()] = asText(asNumber(size.value), 4);
    changed();
    const range = (of) => asText(asNumber(of.value), 3) + ' (' + of.interval.map((end) => asText(asNumber(end), 3)).join(' to ') + ')';
    say('matched: focus ' + range(focus) + ', ' + part('aperture_name').textContent + ' ' + range(size) + '; ranges of 90 %', true);
}

function startPlate() {
    part('plate').hidden = !state.facts.plate;
    part('rectangle').addEventListener('click', () => setDrawing(!plate.drawing));
    part('match').addEventListener('click', match);
    for (const kind of ['pointerdown', 'pointermove', 'pointerup']) part('frame').addEventListener(kind, drawRegion, true);
    if (state.facts.plate) part('with').append(new Option('the plate', 'plate'));
}
