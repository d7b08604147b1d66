"""A small scene, drawn as flat views, as a deep file, and as noisy renders through the lens."""
import numpy

from pictures import SKY, Picture

# Things on planes in an empty frame: only there more or fewer pixels of nothing change nothing. Colours are halves, and
# depths have few bits, so both can be stored in any type, and scaled.
WIDTH, HEIGHT, FOCAL, RADIUS, FOCUS = 48, 32, 48 * 50 / 36, 0.25, 5
DISPLAY = (0, 0, WIDTH - 1, HEIGHT - 1)
LENS = {"focal-length": 50, "sensor-width": 36, "lens-radius": RADIUS, "focus-distance": FOCUS}
RIM = [(RADIUS, 0), (0, RADIUS), (-RADIUS, 0), (0, -RADIUS)]
# Depth, id, coverage, colour and outline of each thing, the nearest first, as the centre view shows it. Two are lamps; one
# of them only the rim views see.
THINGS = [
    (2.5, 3, 1, (0.2, 0.5, 1.0), lambda x, y: (x - 17.3) ** 2 + (y - 15.6) ** 2 < 21),
    (3.5, 4, 0.5, (0.3, 0.9, 0.4), lambda x, y: (x > 26.2) & (x < 33.7) & (y > 9.1) & (y < 15.4)),
    (5, 2, 1, (1.0, 0.7, 0.4), lambda x, y: (x > 20.6) & (x < 35.4) & (y > 11.3) & (y < 21.6)),
    (9, 5, 1, (40, 50, 60), lambda x, y: (x - 15.4) ** 2 + (y - 9.2) ** 2 < 1.4),
    (9.5, 5, 1, (60, 50, 40), lambda x, y: (x - 19.9) ** 2 + (y - 17.2) ** 2 < 1.4),
    (10, 1, 1, (0.7, 0.8, 0.9), lambda x, y: (x > 9.2) & (x < 38.7) & (y > 6.3) & (y < 25.2)),
]


def half(values):
    return numpy.float16(values).astype("<f4")


def pattern(x, y, seed):
    return 0.7 + 0.5 * numpy.sin(x * (0.7 + 0.13 * seed) + y * 0.31 + seed) * numpy.cos(y * (0.53 + 0.07 * seed) - seed)


def seen(x, y, shift):
    """Returns for each thing, moved by shift(depth): depth, id, and at each place its coverage and premultiplied colour."""
    for z, number, alpha, colour, outline in THINGS:
        dx, dy = shift(z)
        covered = alpha * outline(x - dx, y - dy)
        texture = covered * (pattern(x - dx, y - dy, number) if number < 5 else 1)
        yield z, number, covered, numpy.array([texture * c for c in colour])


def places(n=4):
    """n x n places in each pixel."""
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    return [(x + (i + 0.5) / n, y + (j + 0.5) / n) for j in range(n) for i in range(n)]


def view(position=(0, 0)):
    """A flat view from that point of the lens, as a renderer makes it: mean colours, depth and id of what is in front."""
    shape = HEIGHT, WIDTH
    sums, depth, front = numpy.zeros((4, *shape)), numpy.full(shape, SKY, "<f4"), numpy.zeros(shape, "<u4")
    for x, y in places():
        left = numpy.ones(shape)
        for z, number, a, colour in seen(x, y, lambda z: (-FOCAL / z * position[0], FOCAL / z * position[1])):
            sums += left * numpy.array([*colour, a]) / 16
            left = left * (1 - a)
            nearer = (a > 0) & (z < depth)
            depth[nearer], front[nearer] = z, number
    matrix = numpy.eye(4, dtype="<f4")
    matrix[3, :2] = -position[0], -position[1]
    layers = {"IndexOB.X": front, "diffuse.R": half(sums[1] / 2), "N.X": half(front / 8)}
    return Picture({**dict(zip("RGBA", half(sums))), "Z": depth, **layers}, DISPLAY, DISPLAY, attributes={"worldToCamera": ("m44f", matrix.tobytes())})


def rays(seed, count=16):
    """A noisy render through the lens."""
    random, sums = numpy.random.default_rng(seed), numpy.zeros((4, HEIGHT, WIDTH))
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    for _ in range(count):
        r, angle, i, j = random.random((4, *x.shape))
        u, v = numpy.sqrt(r) * numpy.cos(2 * numpy.pi * angle), numpy.sqrt(r) * numpy.sin(2 * numpy.pi * angle)
        left = 1
        for _, _, a, colour in seen(x + i, y + j, lambda z: RADIUS * FOCAL / FOCUS * (z - FOCUS) / z * numpy.array([u, -v])):
            sums += left * numpy.array([*colour, a]) / count
            left = left * (1 - a)
    return Picture(dict(zip("RGBA", half(sums))), DISPLAY, DISPLAY)


def deep(things=None):
    """A deep file of another renderer: all things, also hidden ones, unsorted, and two slabs of fog that overlap."""
    samples, counts = [], numpy.zeros((HEIGHT, WIDTH), "<i4")
    means = sum(numpy.array([[*colour, a] for _, _, a, colour in seen(x, y, lambda z: (0, 0))]) / 16 for x, y in places())
    wanted = [k for k, thing in enumerate(THINGS) if things is None or thing in things]
    for y, x in numpy.ndindex(HEIGHT, WIDTH):
        found = [(*means[k, :, y, x], THINGS[k][0], THINGS[k][0]) for k in wanted if means[k, 3, y, x] > 0]
        if found and things is None:
            found += [(0.125, 0.125, 0.1875, 0.25, 6, 8), (0.0625, 0.125, 0.0625, 0.125, 7, 8.5)]
        samples += found[1::2] + found[0::2]
        counts[y, x] = len(found)
    channels = dict(zip(["R", "G", "B", "A", "Z", "ZBack"], half(samples).T.copy()))
    return Picture({**channels, "diffuse.R": channels["G"] / 2}, DISPLAY, DISPLAY, counts)


def texture():
    """Three grainy walls side by side, for dof-match."""
    grain, box = numpy.random.default_rng(1).random((3, 48, 80)), (0, 0, 79, 47)
    z = numpy.full((48, 80), SKY, "<f4")
    for left, depth in (8, 2.5), (30, 5), (50, 10):
        z[6:42, left:left + 22] = depth
    return Picture({**{name: half(v * (z < SKY)) for name, v in zip("RGB", grain)}, "A": half(z < SKY), "Z": z}, box, box)
