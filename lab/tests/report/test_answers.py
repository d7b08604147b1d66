"""Answers to people's questions."""
from answers import answers
from some_rows import row, traced


def of(renderer, processor, rays, quality):
    return row("", renderer, 1, rays, quality, processor)


def about(rows, word):
    """Where the other way is better, and where five views are."""
    (_, losses, gains), = [answer for answer in answers([rows]) if word in answer[0]]
    return losses, gains


def test_at_which_rays_the_denoiser_is_better():
    rows = [of("centre + 4", "lens normal", 5, 30), of("centre + 4", "lens normal", 80, 40),
            of("denoised ray tracing", "", 5, 28), of("denoised ray tracing", "", 80, 42.5)]
    assert about(rows, "Denoised") == ("fence at 80 rays (up to 2.5 dB)", "fence at 5 rays (up to 2.0 dB)")
    assert not any("Averages" in question for question, _, _ in answers([rows]))


def test_views_may_be_denoised_too():
    """Denoised views may count as the better ones, because denoising needs no rays."""
    rows = [of("centre + 4", "lens normal", 5, 30), of("centre + 4 denoised", "lens normal", 5, 33),
            of("denoised ray tracing", "", 5, 32), of("accumulated lens views", "", 5, 31)]
    assert about(rows, "Denoised") == ("nowhere", "fence at 5 rays (up to 1.0 dB)")
    assert about(rows, "Averages")[0] == "fence at 5 rays (up to 1.0 dB)"  # of plain views


def test_between_the_budgets_of_the_others_their_curve_is_taken():
    rows = traced() + [of("centre + 4", "lens normal", 32, 40),  # 36 dB at 16 rays, 42 at 64
                       of("centre + 4", "lens normal", 320, 50)]  # ray tracing was not measured there
    assert about(rows, "Ray tracing") == ("nowhere", "fence at 32 rays (up to 1.0 dB)")
    assert about(rows, "note")[1].startswith("fence: 0.25 s and no ray; ray tracing o")


def test_programs_of_one_view_are_compared_with_one_view():
    rows = [of("one view", "lens normal", 16, 32), of("one view", "gather", 16, 40),
            of("one view", "Theirs (as it is)", 16, 25), of("one view", "Theirs (at best)", 16, 33.25)]
    assert about(rows, "programs") == ("fence: Theirs (at best) has 33.2 dB, this one 32.0", "nowhere")
