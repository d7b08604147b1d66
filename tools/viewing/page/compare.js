'use strict';

// Shows two pictures of one size, one above the other in `stack`. slide: the upper one shows left of a border at
// `share` percent; flip: the upper one shows if `share` is at least 50, else the lower one; difference: eight times
// their difference.
function compare(stack, above, mode, share) {
    stack.classList.toggle('difference', mode === 'difference');
    const left = mode === 'slide' ? share : mode === 'flip' && share < 50 ? 0 : 100;
    above.style.clipPath = 'inset(0 ' + (100 - left) + '% 0 0)';
}
