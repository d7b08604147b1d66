#include "loading/pose_warnings.h"

#include "checks/pose_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// As --view takes it; as exact as pixels tell it.
std::string text(const Imath::V2d &p) {
    const double rounding = 1e-6 * p.length();
    const auto clean = [rounding](double v) { return std::abs(v) > rounding ? v : 0; };
    return fmt::format("{:.4g},{:.4g}", clean(p.x), clean(p.y));
}

void warn_of_first(const ToolContext &tool, std::span<const View> views, double lens_radius) {
    if (!first_is_at_the_edge(views, lens_radius)) return;
    const auto middle = view_in_the_middle(views);
    warn(tool,
         fmt::format("{}: stands at the edge of the lens, with all other views to one side; give the view "
                     "from the middle first{}",
                     views[0].name, middle ? ", " + views[*middle].name : std::string()));
}

void warn_of_view(const ToolContext &tool, std::span<const View> views, std::size_t i, double focal_px,
                  double reach) {
    const View &view = views[i];
    if (const auto other = same_picture(views, i, focal_px))
        return warn(tool,
                    fmt::format("{}: is the same picture as {}, though it is said to stand at {} and that at "
                                "{}; render it from there, or leave it out",
                                view.name, views[*other].name, text(view.position),
                                text(views[*other].position)));
    if (const auto better = better_position(views[0], view, focal_px, reach))
        warn(tool,
             fmt::format("{}: disagrees with the centre view at its stated position {}; it would agree at {} "
                         "(--view {} {})",
                         view.name, text(view.position), text(*better), text(*better), view.name));
}

} // namespace

void warn_of_wrong_poses(const ToolContext &tool, std::span<const View> views, double focal_px,
                         double lens_radius) {
    warn_of_first(tool, views, lens_radius);
    double reach = 0;
    for (const View &view : views) reach = std::max(reach, view.position.length());
    for (std::size_t i = 1; i < views.size(); ++i)
        warn_of_view(tool, views, i, focal_px, reach > 0 ? reach : lens_radius);
}

} // namespace sparselens
