"""Answers people's questions about a report in a few lines; cases where other ways are better come first.

"Five views" are the centre view and four rim views, gathered by the lens gather at normal quality. Other ways are
compared at equal rays: their measured curve is interpolated, never extrapolated.
"""
from rows import compared, curve_of, fixed, quality_at, ray_tracing_curves, reached_text, significant

FIVE = "centre + 4, lens normal"


def comparison(scenes, question, theirs, ours):
    """theirs, ours: names of methods. Each budget of ours for which the other way has measured as many rays counts."""
    answers = [], []  # where the other way is better, and where not
    for rows in filter(None, scenes):
        curve, mine = (curve_of((row.rays, row.quality) for row in rows if row.method in way) for way in (theirs, ours))
        known = [(rays, other - db) for rays, db in mine if (other := quality_at(curve, rays)) is not None]
        for those, texts in zip(([d for d in known if d[1] > 0], [d for d in known if d[1] <= 0]), answers):
            if those:
                rays, most = ", ".join(significant(d[0], 4) for d in those), fixed(max(abs(d[1]) for d in those), 1)
                texts.append(f"{rows[0].scene} at {rays} rays (up to {most} dB)")
    return question, *answers


def best(rows, is_one):
    return max(filter(is_one, rows), key=lambda row: row.quality, default=None)


def programs(scenes):
    """Rows that other programs made from the centre view and its depths have the programs' options in parentheses."""
    losses, gains = [], []
    for rows in scenes:
        theirs = best(rows, lambda row: row.renderer == "one view" and "(" in row.processor)
        ours = best(rows, lambda row: row.method == "one view, lens normal")
        if theirs and ours:
            text = f"{ours.scene}: {theirs.processor} has {fixed(theirs.quality, 1)} dB, this one "
            (losses if theirs.quality > ours.quality else gains).append(text + fixed(ours.quality, 1))
    return "And other programs on one view and its depths?", losses, gains


def notes(scenes):
    """The cost of a note: only the gather with views, all rays again with ray tracing."""
    gains = []
    for rows in scenes:
        if ours := best(rows, lambda row: row.method == FIVE):
            seconds, rays, _ = compared(ours, ray_tracing_curves(rows))
            gains.append(f"{ours.scene}: {significant(ours.seconds[-1], 2)} s and no ray; ray tracing of that error "
                         f"{reached_text(seconds)} s, {reached_text(rays)} rays")
    losses = ["nowhere: the views stay; a wider lens or another camera needs new ones"] if gains else []
    return "What does a note cost (focus, stop)?", losses, gains


def answers(scenes):
    """(question, where the other way is better, where five views are) for the rows of each scene. Questions about ways
    that no scene has measured are left out."""
    traced = {row.method for rows in scenes for row in rows if row.role == "traced"}
    found = [comparison(scenes, "Denoised ray tracing, of as many rays?", {"denoised ray tracing"},
                        {FIVE, "centre + 4 denoised, lens normal"}),
             comparison(scenes, "Ray tracing the lens as it is?", traced, {FIVE}),
             comparison(scenes, "Averages of many views?", {"accumulated lens views"}, {FIVE}),
             programs(scenes), notes(scenes)]
    return [(question, "; ".join(losses) or "nowhere", "; ".join(gains) or "nowhere")
            for question, losses, gains in found if losses or gains]
