// Time: the frames of a sequence, and keys of the lens over frames. Between two keys, values are linear, or smooth
// (slow at both ends). Before the first key and after the last they are constant, as with the keys of dof-gather.
// keys: { option: { frame: value } }; known, settled: the frame of state.facts, and of the objects.
const time = { frame: 1, keys: {}, known: null, settled: null, playing: false };
const timeRange = () => [Number(part('first').value), Number(part('last').value)];

// The numbers of the frames: of the sequence, else all of the range.
function frameNumbers() {
    const [first, last] = timeRange();
    if (!state.facts.frames) return Array.from({ length: Math.max(1, last - first + 1) }, (_, i) => first + i);
    const within = state.facts.frames.filter((frame) => frame >= first && frame <= last);
    return within.length ? within : state.facts.frames;
}

// The frames as a value of --frames.
function frameText() {
    const frames = frameNumbers(), [first, last] = [frames[0], frames.at(-1)];
    return frames.length > 1 && last - first + 1 === frames.length ? first + '-' + last : frames.join(',');
}

// The values that a key records: focus and f-number, and the looks that are set or have keys.
function keyedNow() {
    const looks = state.facts.looks.filter((look) => look.keyable && look.control === 'number').map((look) => look.name);
    const set = looks.filter((name) => name in time.keys || name in state.settings);
    return { 'focus-distance': focusNow(), [aperture()]: apertureNow(),
        ...Object.fromEntries(set.map((name) => [name, Number(state.settings[name] ?? time.keys[name]?.[time.frame] ?? 0)])) };
}

function setKey() {
    for (const [option, value] of Object.entries(keyedNow())) (time.keys[option] ??= {})[time.frame] = Math.min(value, 1e6);
    sayTime();
    remember();
    sayCommand();
}

function removeKey() {
    for (const [option, keys] of Object.entries(time.keys)) {
        delete keys[time.frame];
        if (Object.keys(keys).length === 0) delete time.keys[option];
    }
    sayTime();
    remember();
}

function valueAt(keys, frame) {
    const frames = Object.keys(keys).map(Number).sort((a, b) => a - b);
    const after = frames.find((f) => f >= frame) ?? frames.at(-1), before = frames.findLast((f) => f <= frame) ?? frames[0];
    if (after === before) return keys[after];
    const share = (frame - before) / (after - before), moved = part('smooth').checked ? share * share * (3 - 2 * share) : share;
    return keys[before] + (keys[after] - keys[before]) * moved;
}

// Goes to the nearest existing frame.
async function goTo(frame) {
    time.frame = frameNumbers().reduce((best, each) => Math.abs(each - frame) < Math.abs(best - frame) ? each : best);
    for (const [option, keys] of Object.entries(time.keys)) state.settings[option] = asText(valueAt(keys, time.frame), 9);
    sayTime();
    remember(true);
    await changed();
}

function step(by) {
    const frames = frameNumbers();
    return goTo(frames[Math.min(frames.length - 1, Math.max(0, frames.indexOf(time.frame) + by))]);
}

// Plays the frames in a loop, each as soon as the one before is on screen.
async function play() {
    time.playing = !time.playing;
    part('play').classList.toggle('on', time.playing);
    while (time.playing) {
        const frames = frameNumbers();
        await goTo(frames[(frames.indexOf(time.frame) + 1) % frames.length]);
        if (state.overlay) await full('normal'); // false colours have no drafts
        await new Promise(requestAnimationFrame);
    }
    remember(true);
}

// Asks for the facts of the frame before it is shown, because its size, depths and lens may differ.
async function knowFrame() {
    if (!state.facts.frames || time.known === time.frame) return;
    const frame = time.frame;
    state.facts = await (await ask('facts', { frame })).json();
    time.known = frame;
    part('name').textContent = state.facts.file;
    forgetObjects();
    if (place.fitted) fit();
}

// Loads what takes longer, once the page rests on the frame.
async function knowMore() {
    if (!state.facts.frames || time.settled === time.known || time.playing) return;
    time.settled = time.known;
    await Promise.all([loadObjects(), loadTarget()]);
}

// Frames and values of an option: its keys, or every frame if they are smooth.
function baked(option) {
    const keys = time.keys[option] ?? {}, frames = part('smooth').checked ? frameNumbers() : Object.keys(keys).map(Number);
    return frames.map((frame) => [frame, asText(valueAt(keys, frame), 9)]);
}

// Quotes a word for a shell.
const quoted = (word) => /^[-\w=+,./:@%#]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";

// The command for a range of frames: the command of one frame, with keys as values.
async function rangeCommand(frames) {
    const { range, range_output } = await commandsNow(), words = [];
    for (let i = 0; i < range.length; ++i)
        if (!(range[i].replace(/^--|=.*$/gs, '') in time.keys)) words.push(range[i]);
        else if (!range[i].includes('=')) ++i; // and its value
    for (const option of Object.keys(time.keys)) words.push('--' + option, baked(option).map((pair) => pair.join(':')).join(','));
    return ['dof-gather', ...words.map(quoted), '--frames', frames, '-o', quoted(range_output)].join(' ');
}

const forms = {
    'command of all frames': () => rangeCommand(frameText()),
    'job for Slurm': async () => `sbatch --array=${frameText()} --wrap ` + quoted(await rangeCommand('$SLURM_ARRAY_TASK_ID')),
    'focus, for --focus-distance @file': () => baked('focus-distance').map((pair) => pair.join(':')).join('\n') + '\n',
    'f-number, for --fstop @file': () => baked(aperture()).map((pair) => pair.join(':')).join('\n') + '\n',
    'all keys as JSON': () => JSON.stringify({ frames: timeRange(), smooth: part('smooth').checked, keys: time.keys }, null, 1),
    'focus as a curve of Nuke': () => '{curve L ' + baked('focus-distance').map(([frame, value]) => `x${frame} ${value}`).join(' ') + '}',
};

function sayTime() {
    const [first, last] = [frameNumbers()[0], frameNumbers().at(-1)], frames = new Set(Object.values(time.keys).flatMap((keys) => Object.keys(keys)));
    part('frame_number').min = first;
    part('frame_number').max = last;
    part('frame_number').value = time.frame;
    part('frame_text').textContent = time.frame;
    part('key').classList.toggle('on', frames.has(String(time.frame)));
    part('keyed').textContent = frames.size ? 'keys at ' + [...frames].sort((a, b) => a - b).join(', ') : 'no keys';
    part('copy_time').disabled = frames.size === 0 && !state.facts.frames;
}

function startTime() {
    if (state.facts.frames) {
        [part('first').value, part('last').value] = [Math.min(...state.facts.frames), Math.max(...state.facts.frames)];
        time.frame = time.known = time.settled = state.facts.frames[0];
        part('time').open = true;
    }
    part('play').addEventListener('click', play);
    for (const name of Object.keys(forms)) part('form').append(new Option(name, name));
    for (const id of ['first', 'last', 'smooth']) part(id).addEventListener('change', () => {
        remember();
        goTo(time.frame);
    });
    part('frame_number').addEventListener('input', () => goTo(Number(part('frame_number').value)));
    part('key').addEventListener('click', setKey);
    part('no_key').addEventListener('click', removeKey);
    part('copy_time').addEventListener('click', async () => copyText(await forms[part('form').value]()));
    sayTime();
}
