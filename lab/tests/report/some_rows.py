"""Rows for tests."""
from rows import Row


def row(role, renderer, seconds, rays, quality, processor=None):
    if processor is None:
        processor = "" if role == "traced" else "lens"
    made = Row(scene="fence", renderer=renderer, processor=processor, budget=f"{rays} rays", role=role, rays=rays,
               seconds=[0.75 * seconds, 0, 0, 0, 0.25 * seconds], runs=3)
    made.errors[0]["psnr_tonemapped"] = quality
    return made


def traced():
    """Gains 3 dB when the time doubles: 30 dB in a second, 4 rays per second."""
    return [row("traced", "traced", 1, 4, 30), row("traced", "traced", 4, 16, 36), row("traced", "traced", 16, 64, 42)]


def sparse(seconds, rays, quality, renderer="sparse"):
    return row("sparse", renderer, seconds, rays, quality)
