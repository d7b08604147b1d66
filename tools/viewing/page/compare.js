'use strict';

// Two pictures of one size, one above the other in `stack`. Slide: the upper one is seen left of a border at `share` percent;
// flip: all of it, or for a share below a half none; difference: eight times that of the two.
function compare(stack, above, mode, share) {
    stack.classList.toggle('difference', mode === 'difference');
    const left = mode === 'slide' ? share : mode === 'flip' && share < 50 ? 0 : 100;
    above.style.clipPath = 'inset(0 ' + (100 - left) + '% 0 0)';
}
