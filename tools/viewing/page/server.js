// Requests to the server, and its answers.
const key = new URLSearchParams(location.search).get('key');
const page = Array.from(crypto.getRandomValues(new Uint8Array(12)), (byte) => (byte % 36).toString(36)).join('');
const part = (id) => document.getElementById(id);

// Returns the response; null if this page has asked for something newer. Throws the server's error message.
async function ask(path, asked) {
    const body = JSON.stringify({ page, ...(state.facts?.frames && { frame: time.frame }), ...asked });
    const response = await fetch('/' + path, { method: 'POST', headers: { 'X-Sparselens-Key': key }, body }).catch(() => null);
    if (!response || response.status === 403) {
        lose();
        throw new Error(''); // the bar reports it
    }
    if (response.status === 409) return null;
    if (!response.ok) throw new Error((await response.text()).trim());
    return response;
}

// If the server is lost, the page keeps its state, says so in a bar, and continues as soon as the server answers.
const server = { lost: false };

function lose() {
    if (server.lost) return;
    server.lost = true;
    part('ended').hidden = false;
    setTimeout(findAgain, 1000);
}

async function findAgain() {
    try {
        await ask('progress', {});
    } catch {
        setTimeout(findAgain, 1000);
        return;
    }
    server.lost = false;
    part('ended').hidden = true;
    if (state.facts) await changed();
    else location.reload();
}

function startServer() {
    setInterval(() => server.lost || document.hidden || ask('progress', {}).catch(() => {}), 5000);
    part('go_on').addEventListener('submit', (event) => {
        event.preventDefault();
        const given = part('address').value.trim(), to = URL.canParse(given) ? new URL(given) : null;
        const isOne = to?.searchParams.has('key') && ['127.0.0.1', 'localhost'].includes(to.hostname);
        part('address').classList.toggle('wrong', !isOne);
        if (!isOne) return;
        to.hash = location.hash;
        location.assign(to);
    });
}

// Splits an answer into its JSON and the bytes after it.
async function apart(response) {
    const bytes = await response.arrayBuffer();
    const size = new DataView(bytes).getUint32(0, true);
    return { said: JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, size))), bytes: new Uint8Array(bytes, 4 + size) };
}

// Makes an ImageData of the bytes that are a picture's pixels.
function imageOf({ width, height, channels }, from) {
    const count = width * height, data = new Uint8ClampedArray(4 * count);
    if (channels === 4) data.set(from);
    else for (let i = 0, k = 0, to = 0; i < count; ++i, k += 3, to += 4) {
        data[to] = from[k];
        data[to + 1] = from[k + 1];
        data[to + 2] = from[k + 2];
        data[to + 3] = 255;
    }
    return new ImageData(data, width, height);
}

async function pictureOf(response) {
    const { said, bytes } = await apart(response);
    return { said, data: imageOf(said, bytes) };
}

// Shows a message at the foot of the picture until the next one: an error, or a note.
function say(text, isNote = false) {
    part('said').textContent = text;
    part('said').classList.toggle('note', isNote);
    part('said').hidden = !text;
}

const asNumber = (value) => value === 'inf' ? Infinity : Number(value);
const asText = (value, digits = 4) => Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : Number.isNaN(value) ? '' : 'inf';
// The unit of depth.
const unit = () => ({ 1: 'm', 0.01: 'cm', 0.001: 'mm' })[state.facts.metres_per_unit] ?? 'units';
