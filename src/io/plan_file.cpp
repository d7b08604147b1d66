#include "io/plan_file.h"

#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/files/folder.h"
#include "io/files/text_file.h"
#include "plan/rectangles.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace sparselens {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json json_of(const Imath::Box2i &box) { return {box.min.x, box.min.y, box.max.x, box.max.y}; }

// JSON has no infinity.
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Imath::Box2i bounds_of(const std::vector<Imath::Box2i> &boxes) {
    Imath::Box2i all;
    for (const Imath::Box2i &box : boxes) all.extendBy(box);
    return all;
}

std::string write_mask(const std::string &plan_path, const std::string &folder, const std::string &name,
                       const PixelMask &mask, const Windows &windows) {
    make_folder(folder);
    Image image(windows, {{"A", PixelType::half}});
    std::ranges::copy(mask.set, image.plane(0).begin());
    const fs::path file = fs::path(folder) / (name + ".exr");
    write_flat_exr(file.string(), image, {});
    return plan_path == "-" ? file.string()
                            : file.lexically_proximate(fs::path(plan_path).parent_path()).string();
}

Json json_of(const PlannedView &view, const std::string &name, const ThinLens &lens) {
    const std::vector<Imath::Box2i> rectangles = rectangles_over(view.mask);
    Json json{{"name", name},
              {"lens_point", {view.u.x, view.u.y}},
              {"position", {lens.radius * view.u.x, lens.radius * view.u.y}},
              {"share", double(view.mask.count()) / double(view.mask.set.size())},
              {"uncovered", view.uncovered},
              {"data_window", json_of(bounds_of(rectangles))},
              {"rectangles", Json::array()}};
    for (const Imath::Box2i &box : rectangles) json["rectangles"].push_back(json_of(box));
    return json;
}

Imath::Box2i box_of(const Json &json) {
    const Imath::Box2i box({json.at(0), json.at(1)}, {json.at(2), json.at(3)});
    constexpr double most = 1 << 28; // pixels: no picture has more
    const double width = double(box.max.x) - box.min.x + 1, height = double(box.max.y) - box.min.y + 1;
    if (!(width > 0 && height > 0 && width * height <= most)) throw Error("a window is empty or too large");
    return box;
}

// The rectangles' pixels, or the mask's.
PixelMask mask_of(const Json &view, const fs::path &folder) {
    PixelMask mask(box_of(view.at("data_window")));
    if (view.contains("mask")) {
        const Image image = read_flat_exr((folder / view.at("mask").get<std::string>()).string()).image;
        const std::size_t alpha = find_channel(image.channels, "A");
        if (alpha == npos) throw Error("a mask has no channel A");
        for (int y = mask.data.min.y; y <= mask.data.max.y; ++y)
            for (int x = mask.data.min.x; x <= mask.data.max.x; ++x)
                if (image.windows.data.intersects(Imath::V2i(x, y)))
                    mask.set[mask.index(x, y)] = image.at(alpha, x, y) > 0;
        return mask;
    }
    for (const Json &rectangle : view.at("rectangles")) {
        const Imath::Box2i box = box_of(rectangle);
        for (int y = std::max(box.min.y, mask.data.min.y); y <= std::min(box.max.y, mask.data.max.y); ++y)
            for (int x = std::max(box.min.x, mask.data.min.x); x <= std::min(box.max.x, mask.data.max.x); ++x)
                mask.set[mask.index(x, y)] = 1;
    }
    return mask;
}

} // namespace

void write_plan(const std::string &path, const Plan &plan, const PlanSetting &setting,
                const std::string &masks) {
    const ThinLens &lens = setting.lens;
    const char *advice = plan.views.empty() ? "none" : plan.full_views ? "full" : "planned";
    Json json{
        {"version", 1},
        {"center", setting.centre},
        {"display_window", json_of(setting.windows.display)},
        {"data_window", json_of(setting.windows.data)},
        {"lens",
         {{"radius", lens.radius}, {"focal_px", lens.focal_px}, {"focus_distance", json_of(lens.focus)}}},
        {"margin", setting.margin},
        {"share", plan.share()},
        {"advice", advice},
        {"noise_db", json_of(-10 * std::log10(plan.noise))},
        {"overscan",
         {{"left", plan.overscan.left},
          {"top", plan.overscan.top},
          {"right", plan.overscan.right},
          {"bottom", plan.overscan.bottom}}},
        {"views", Json::array()}};
    for (std::size_t k = 0; k < plan.views.size(); ++k) {
        const std::string name = fmt::format("view_{}", k);
        Json view = json_of(plan.views[k], name, lens);
        if (!masks.empty()) view["mask"] = write_mask(path, masks, name, plan.views[k].mask, setting.windows);
        json["views"].push_back(view);
    }
    write_text_file(path, json.dump(1) + "\n");
}

PlanRequest read_plan(const std::string &path) {
    try {
        const Json json = Json::parse(read_text_file(path));
        PlanRequest request{box_of(json.at("display_window")), {}};
        for (const Json &view : json.at("views")) {
            const Json &u = view.at("lens_point");
            request.views.push_back(
                {view.at("name"), {u.at(0), u.at(1)}, mask_of(view, fs::path(path).parent_path())});
        }
        return request;
    } catch (const nlohmann::json::exception &error) {
        throw Error(fmt::format("{}: not a plan of ldi-plan: {}", display_name(path), error.what()));
    } catch (const Error &error) {
        const std::string what = error.what();
        throw Error(what.starts_with(display_name(path)) ? what : display_name(path) + ": " + what);
    }
}

} // namespace sparselens
