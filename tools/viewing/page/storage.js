// The settings, as steps that can be undone, and in the address, from which a reload or another dof-view restores them.
const past = { steps: [], at: -1 };

function snapshot() {
    const { settings, exposure } = state, { frame, keys } = time;
    return JSON.stringify({ settings, exposure, frame, keys, range: timeRange(), smooth: part('smooth').checked, format: part('format').value });
}

// Records a change as a new step; if only the frame has changed, replaces the last step.
function remember(onlyMoved = false) {
    const now = snapshot();
    if (time.playing || now === past.steps[past.at]) return;
    if (onlyMoved && past.at >= 0) past.steps[past.at] = now;
    else past.steps.splice(++past.at, Infinity, now);
    history.replaceState(null, '', '#' + encodeURIComponent(now));
}

function restore(text) {
    const { settings, exposure, frame, keys, range, smooth, format } = JSON.parse(text);
    [state.settings, state.exposure, time.keys] = [settings, exposure, keys];
    [part('first').value, part('last').value] = range;
    [part('smooth').checked, part('format').value] = [smooth, format];
    if (frameNumbers().includes(frame)) time.frame = frame;
    sayTime();
}

function undo(steps) {
    remember();
    if (!past.steps[past.at + steps]) return;
    past.at += steps;
    restore(past.steps[past.at]);
    history.replaceState(null, '', '#' + encodeURIComponent(past.steps[past.at]));
    changed();
}

function restoreFromAddress() {
    try {
        if (location.hash) restore(decodeURIComponent(location.hash.slice(1)));
    } catch {
        say('the settings in the address cannot be read');
    }
}
