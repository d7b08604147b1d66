#include "deep/checks/view_warnings.h"

#include "base/parallel.h"
#include "deep/checks/picture_checks.h"
#include "deep/checks/pose_check.h"
#include "view/resolve_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// A position as `view` takes it, with the precision that pixels give.
std::string text(const Imath::V2d &p) {
    const double rounding = 1e-6 * p.length();
    const auto clean = [rounding](double v) { return std::abs(v) > rounding ? v : 0; };
    return fmt::format("{:.4g},{:.4g}", clean(p.x), clean(p.y));
}

using Warnings = std::vector<std::string>;

void say_of_unit(const std::string &name, std::span<const float> depths, const ThinLens &lens,
                 Warnings &said) {
    const double largest = largest_circle_of_confusion(depths, lens);
    if (blurs_nothing(largest, lens))
        said.push_back(fmt::format(
            "{}: the largest circle of confusion is {:.2g} pixels, so the lens blurs nothing: check the "
            "unit of the scene (`scene_unit=0.01` if it is a centimetre), the aperture and the focus",
            name, largest));
}

void say_of_lens(const View &view, const ThinLens &lens, Warnings &said) {
    say_of_unit(view.name, view.z, lens, said);
    if (looks_defocused(sharpness_of_edges(view, lens)))
        said.push_back(view.name +
                       ": its edges out of focus are blurred, so the render seems to have depth of field, "
                       "which would be applied twice: switch depth of field off in the render");
}

void say_of_first(std::span<const PackedView> views, double lens_radius, Warnings &said) {
    if (!first_is_at_the_edge(views, lens_radius)) return;
    const auto middle = view_in_the_middle(views);
    said.push_back(
        fmt::format("{}: stands at the edge of the lens, with all other views to one side; give the view "
                    "from the middle first{}",
                    views[0].name, middle ? ", " + views[*middle].name : std::string()));
}

void say_of_distances(std::span<const PackedView> views, const std::vector<std::size_t> &beyond,
                      double lens_radius, Warnings &said) {
    if (beyond.empty()) return;
    const PackedView &view = views[beyond.front()];
    said.push_back(fmt::format(
        "{}{}: stands {:.4g} from the centre, {:.4g} times the radius of the lens, {:.4g}: in millimetres? "
        "Positions (`view`) and the radius are in scene units, and `scene_unit` says how long one is",
        view.name, beyond.size() > 1 ? fmt::format(" and {} more", beyond.size() - 1) : "",
        view.position.length(), view.position.length() / lens_radius, lens_radius));
}

// The warning for a view that repeats another one; empty if it does not.
std::string said_of_copy(std::span<const PackedView> views, std::size_t i, double focal_px) {
    const PackedView &view = views[i];
    if (const auto other = same_picture_and_place(views, i))
        return fmt::format(
            "{}: is the same picture as {}, from the same place, and counts twice; leave it out", view.name,
            views[*other].name);
    if (const auto other = same_picture(views, i, focal_px))
        return fmt::format("{}: is the same picture as {}, though it is said to stand at {} and that at "
                           "{}; render it from there, or leave it out",
                           view.name, views[*other].name, text(view.position), text(views[*other].position));
    return {};
}

// The warning for a view at a wrong position, and the share of its stated distance from the centre at which it would
// agree; empty and 0 if its position is right.
struct Pose {
    std::string said;
    double share = 0;
};

Pose pose_of(std::span<const PackedView> views, std::size_t i, double focal_px, double reach) {
    const PackedView &view = views[i];
    if (const auto turned = turned_by(views[0], view, focal_px, reach))
        return {fmt::format(
            "{}: disagrees with the centre view, and would agree if it were turned by {:.2g} degrees to the "
            "right and {:.2g} up (or its lens shifted so): render all views with parallel axes, not aimed "
            "at the focus",
            view.name, turned->x, turned->y)};
    const auto better = better_position(views[0], view, focal_px, reach);
    if (!better) return {};
    const double stated = view.position.length2();
    return {fmt::format("{}: disagrees with the centre view at its stated position {}; it would agree at {} "
                        "(`view={} {}`)",
                        view.name, text(view.position), text(*better), text(*better), view.name),
            stated > 0 ? view.position.dot(*better) / stated : 0};
}

// Says which focal length would let most views agree where they are said to stand.
void say_of_focal_length(std::span<const Pose> poses, const Camera &camera, Warnings &said) {
    std::vector<double> shares;
    for (const Pose &pose : poses)
        if (pose.share > 0) shares.push_back(pose.share);
    std::ranges::sort(shares);
    if (shares.size() < 3 || !camera.focal_length_mm) return;
    const double usual = shares[shares.size() / 2];
    constexpr double alike = 0.15; // the positions that are tried are as far apart
    const auto like_it = [&](double share) { return std::abs(share - usual) <= alike * usual; };
    const auto count = std::ranges::count_if(shares, like_it);
    const double focal_length = usual * *camera.focal_length_mm;
    if (count >= 3)
        said.push_back(
            fmt::format("{} views would agree at about {:.2g} times their stated positions: or the "
                        "focal length is about {:.2g}, not {:.4g} (`focal_length={:.2g}`)",
                        count, usual, focal_length, *camera.focal_length_mm, focal_length));
}

} // namespace

Warnings picture_warnings(const View &view, const ViewFacts &facts) {
    Warnings said;
    if (facts.unpremultiplied)
        said.push_back(view.name +
                       ": its edges stay as bright as the surfaces where A falls, so its colours seem to be "
                       "unpremultiplied: if they are, give `unpremultiplied`, or write them multiplied by A");
    if (lacks_coverage(view))
        said.push_back(view.name +
                       ": its coverage (A) is 0 everywhere, so all is light that hides nothing: if it "
                       "shows surfaces, write their coverage, or leave A out if all is opaque");
    if (const EdgeDepths edges = depths_at_edges(view); looks_multiplied(edges))
        said.push_back(view.name + ": its depth is multiplied by its coverage at soft edges: divide it by A");
    else if (looks_averaged(edges) && !facts.depth_filtered)
        said.push_back(view.name +
                       ": its depth is averaged with what lies behind at soft edges: render depth without a "
                       "filter, as the closest or the first sample of each pixel");
    if (looks_encoded(mixing_at_edges(view)))
        said.push_back(view.name +
                       ": its colours mix at edges as sRGB codes do, not as light does: if they are encoded "
                       "for a display, give `colorspace=sRGB`, or render scene-linear");
    if (facts.depth_filtered)
        said.push_back(view.name +
                       ": its depth is averaged over edges and was repaired where possible: render depth "
                       "without a filter, as the closest or the first sample of each pixel");
    if (facts.depth == DepthMeaning::planar && looks_inverse(slopes_of_depth(view)))
        said.push_back(view.name +
                       ": its depths are linear in 1 / z, as planes show: give `depth=inverse` where what is "
                       "near has the larger values, else `depth=hyperbolic` with `near` and `far`");
    if (const auto lens = known_lens(facts.camera, view.image.windows)) say_of_lens(view, *lens, said);
    return said;
}

namespace {

// Edges are not tested in a deep view, because its pixels mix nothing.
Warnings first_warnings(const PackedView &first, const ViewFacts &facts) {
    if (!first.samples.deep()) return picture_warnings(unpacked(first), facts);
    Warnings said;
    if (const auto lens = known_lens(facts.camera, first.samples.windows))
        say_of_unit(first.name, first.samples.depths(), *lens, said);
    return said;
}

void say_of_flat_first(std::span<const PackedView> views, Warnings &said) {
    const auto deep = [](const PackedView &view) { return view.samples.deep(); };
    const auto other = std::ranges::find_if(views, deep);
    if (other != views.end() && other != views.begin())
        said.push_back(
            fmt::format("{}: is flat, and {} is deep: where the first view shows several surfaces as one, "
                        "deep views from the rim cannot part them; give its deep picture",
                        views[0].name, other->name));
}

} // namespace

Warnings view_warnings(std::span<const View> views, const ViewFacts &facts) {
    return view_warnings(referring_to(views), facts);
}

Warnings view_warnings(const std::vector<PackedView> &views, const ViewFacts &facts) {
    const double radius = lens_radius_of(facts.camera).value_or(0); // 0: unknown
    const double focal_px =
        focal_length_px(facts.camera, views[0].samples.windows.display_width()).value_or(0);
    double reach = 0;
    for (const PackedView &view : views) reach = std::max(reach, view.position.length());
    const std::vector<std::size_t> beyond = views_beyond_lens(views, radius); // their pixels are not tested
    Warnings said;
    std::vector<Pose> poses(views.size());
    parallel_for(views.size(), [&](std::size_t i) {
        if (i == 0)
            said = first_warnings(views[0], facts);
        else if (poses[i].said = said_of_copy(views, i, focal_px);
                 poses[i].said.empty() && !std::ranges::binary_search(beyond, i))
            poses[i] = pose_of(views, i, focal_px, reach > 0 ? reach : radius);
    });
    say_of_flat_first(views, said);
    if (beyond.empty()) say_of_first(views, radius, said);
    say_of_distances(views, beyond, radius, said);
    for (const Pose &pose : poses)
        if (!pose.said.empty()) said.push_back(pose.said);
    say_of_focal_length(poses, facts.camera, said);
    return said;
}

} // namespace sparselens
