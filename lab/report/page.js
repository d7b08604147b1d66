// One viewer per scene: the left picture is above the right one and is cut off at the slider.
function startViewer(viewer) {
    const part = (name) => viewer.querySelector('.' + name);
    const pictures = viewer.querySelectorAll('.pictures img');
    const above = part('above'), below = part('below'), stack = part('stack'), slider = part('slider');

    function show() {
        const mode = part('mode').value, zoom = Number(part('zoom').value);
        const width = pictures[0].naturalWidth * zoom, height = pictures[0].naturalHeight * zoom;
        above.src = pictures[part('left').value].src;
        below.src = pictures[part('right').value].src;
        for (const box of [stack, above, below]) {
            box.style.width = width + 'px';
            box.style.height = height + 'px';
        }
        compare(stack, above, mode, Number(slider.value));
    }

    // Pressing or dragging on the picture moves the slider; in flip mode a press flips.
    function drag(event) {
        if (event.buttons !== 1) return;
        event.preventDefault();
        if (part('mode').value === 'flip') {
            if (event.type === 'pointerdown') slider.value = Number(slider.value) < 50 ? 100 : 0;
        } else {
            const box = stack.getBoundingClientRect();
            slider.value = 100 * (event.clientX - box.left) / box.width;
        }
        show();
    }

    // Fits the picture to the width of the page, in whole pixels.
    function fill() {
        const zoom = part('zoom');
        for (const option of zoom.options)
            if (pictures[0].naturalWidth * Number(option.value) <= viewer.clientWidth) zoom.value = option.value;
    }

    for (const name of ['left', 'right', 'mode', 'zoom', 'slider']) part(name).addEventListener('input', show);
    stack.addEventListener('pointerdown', drag);
    stack.addEventListener('pointermove', drag);
    Promise.all(Array.from(pictures, (picture) => picture.decode())).then(fill).then(show);
}

document.querySelectorAll('.viewer').forEach(startViewer);
