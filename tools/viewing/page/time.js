// Time: keys of the lens over frames. Between two keys values are linear, or smooth: slow at both; beyond the first and the last
// they stay, as the keys of dof-gather do.
const time = { frame: 1, keys: {} }; // keys: { option: { frame: value } }
const timeRange = () => [Number(part('first').value), Number(part('last').value)];

// What a key is of: focus and f-number, and the looks that were set or have keys.
function keyedNow() {
    const looks = state.facts.looks.map((look) => look.name).filter((name) => !name.startsWith('highlight'));
    const set = looks.filter((name) => name in time.keys || name in state.settings);
    return { 'focus-distance': focusNow(), [aperture()]: apertureNow(),
        ...Object.fromEntries(set.map((name) => [name, Number(state.settings[name] ?? time.keys[name]?.[time.frame] ?? 0)])) };
}

function setKey() {
    for (const [option, value] of Object.entries(keyedNow())) (time.keys[option] ??= {})[time.frame] = Math.min(value, 1e6);
    sayTime();
    sayCommand();
}

function removeKey() {
    for (const [option, keys] of Object.entries(time.keys)) {
        delete keys[time.frame];
        if (Object.keys(keys).length === 0) delete time.keys[option];
    }
    sayTime();
}

function valueAt(keys, frame) {
    const frames = Object.keys(keys).map(Number).sort((a, b) => a - b);
    const after = frames.find((f) => f >= frame) ?? frames.at(-1), before = frames.findLast((f) => f <= frame) ?? frames[0];
    if (after === before) return keys[after];
    const share = (frame - before) / (after - before), moved = part('smooth').checked ? share * share * (3 - 2 * share) : share;
    return keys[before] + (keys[after] - keys[before]) * moved;
}

function goTo(frame) {
    const [first, last] = timeRange();
    time.frame = Math.min(last, Math.max(first, Math.round(frame)));
    for (const [option, keys] of Object.entries(time.keys)) state.settings[option] = asText(valueAt(keys, time.frame), 9);
    sayTime();
    changed();
}

// Frames and values of an option: its keys, or where they are smooth every frame.
function baked(option) {
    const keys = time.keys[option] ?? {}, [first, last] = timeRange();
    const frames = part('smooth').checked ? Array.from({ length: last - first + 1 }, (_, i) => first + i) : Object.keys(keys).map(Number);
    return frames.map((frame) => [frame, asText(valueAt(keys, frame), 9)]);
}

// The command for all frames: that of one, with keys for values.
async function rangeCommand() {
    await sayCommand();
    let command = state.commands.shell.replace(/ -o ('?)(.*?)\.png('?)$/, ` --frames ${timeRange().join('-')} -o $1$2.####.png$3`);
    for (const option of Object.keys(time.keys)) {
        const keys = ` --${option} ` + baked(option).map((pair) => pair.join(':')).join(',');
        command = command.replace(new RegExp(` --${option}[ =]\\S+`), '').replace(' --frames', keys + ' --frames');
    }
    return command;
}

const forms = {
    'command of all frames': rangeCommand,
    'job for Slurm': async () => `sbatch --array=${timeRange().join('-')} --wrap "` +
        (await rangeCommand()).replace(/--frames \S+/, '--frames \\$SLURM_ARRAY_TASK_ID') + '"',
    'focus, for --focus-distance @file': () => baked('focus-distance').map((pair) => pair.join(':')).join('\n') + '\n',
    'f-number, for --fstop @file': () => baked(aperture()).map((pair) => pair.join(':')).join('\n') + '\n',
    'all keys as JSON': () => JSON.stringify({ frames: timeRange(), smooth: part('smooth').checked, keys: time.keys }, null, 1),
    'focus as a curve of Nuke': () => '{curve L ' + baked('focus-distance').map(([frame, value]) => `x${frame} ${value}`).join(' ') + '}',
};

function sayTime() {
    const [first, last] = timeRange(), frames = new Set(Object.values(time.keys).flatMap((keys) => Object.keys(keys)));
    part('frame_number').min = first;
    part('frame_number').max = last;
    part('frame_number').value = time.frame;
    part('frame_text').textContent = time.frame;
    part('key').classList.toggle('on', frames.has(String(time.frame)));
    part('keyed').textContent = frames.size ? 'keys at ' + [...frames].sort((a, b) => a - b).join(', ') : 'no keys';
    part('copy_time').disabled = frames.size === 0;
}

function startTime() {
    for (const name of Object.keys(forms)) part('form').append(new Option(name, name));
    for (const id of ['first', 'last', 'smooth']) part(id).addEventListener('change', () => goTo(time.frame));
    part('frame_number').addEventListener('input', () => goTo(Number(part('frame_number').value)));
    part('key').addEventListener('click', setKey);
    part('no_key').addEventListener('click', removeKey);
    part('copy_time').addEventListener('click', async () => copyText(await forms[part('form').value]()));
    sayTime();
}
