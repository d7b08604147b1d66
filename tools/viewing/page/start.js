// Starts the page.
async function start() {
    startServer();
    state.facts = await (await ask('facts', {})).json();
    document.title = 'dof-view: ' + state.facts.name;
    part('frame').tabIndex = 0;
    startPanel();
    startOverlays();
    startPlate();
    startTime();
    startPointer();
    startKeys();
    for (const canvas of [part('above'), part('below'), part('marks')]) draw(canvas, new ImageData(1, 1));
    restoreFromAddress();
    loadTarget();
    fit();
    part('frame').focus();
    await changed();
    await loadObjects();
}
start().catch((error) => say(error.message));
