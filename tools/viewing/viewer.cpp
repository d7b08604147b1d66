#include "viewing/viewer.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "io/exr/exr_flat.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <utility>

namespace sparselens {

namespace {

using Json = nlohmann::json;

std::string with_bytes(const Json &said, const std::vector<std::uint8_t> &bytes) {
    // What a file or a message holds need not be UTF-8.
    const std::string json = said.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string answer;
    answer.reserve(4 + json.size() + bytes.size());
    for (int byte = 0; byte < 4; ++byte) answer += char(std::uint32_t(json.size()) >> (8 * byte) & 255);
    answer += json;
    answer.append(reinterpret_cast<const char *>(bytes.data()), bytes.size());
    return answer;
}

Json size_of(const ShownPixels &pixels) {
    return {{"width", pixels.width}, {"height", pixels.height}, {"channels", pixels.channels}};
}

std::string stem_of(const std::string &path) {
    return path == "-" ? "picture" : std::filesystem::path(path).stem().stem().string();
}

Json look_table() {
    Json all = Json::array();
    for (const auto table : {look_numbers(), highlight_numbers()})
        for (const LookNumber &number : table)
            all.push_back({{"name", number.name},
                           {"unit", number.unit},
                           {"help", number.help},
                           {"range", number.range}});
    return all;
}

} // namespace

Viewer::Viewer(const ViewOptions &options, const Words &words, const ToolContext &tool)
    : options_(options), words_(picture_words(words)), tool_(tool), shot_(options.picture, tool),
      depths_(depth_extent(shot_.in().ldi)), names_(object_names(shot_.in().header)) {
    shot_.lens(shot_.camera(options.picture)); // what is unknown is a matter of the command line
    if (!options.reference.empty()) reference_ = read_flat_exr(options.reference).image;
    if (!options.save.empty() && !std::filesystem::is_directory(options.save))
        throw Error(options.save + ": is not a folder, where --save could write");
}

Words Viewer::words_of(const Asked &asked) const {
    return words_with(words_, asked.settings, options_.presets);
}

std::string Viewer::facts() const {
    const Imath::Box2i display = reduced(shot_.in().ldi.windows.display, shot_.across());
    const Camera camera = shot_.camera(options_.picture);
    Json facts{{"name", stem_of(options_.picture.input)},
               {"file", shot_.in().name},
               {"min", {display.min.x, display.min.y}},
               {"width", display.max.x - display.min.x + 1},
               {"height", display.max.y - display.min.y + 1},
               {"pixel_aspect", shot_.in().ldi.windows.pixel_aspect},
               {"samples", shot_.in().ldi.samples()},
               {"lens_method", options_.picture.picture.method == &gather_methods().front()},
               {"looks", look_table()},
               {"reference", reference_.has_value()},
               {"save", !options_.save.empty()},
               {"objects", !names_.empty()},
               {"nearest", json_number(depths_.nearest)},
               {"farthest", json_number(depths_.farthest)}};
    for (const auto &preset : options_.presets) facts["lenses"].push_back(preset.first);
    for (const auto &type : chromatic_types()) facts["chromatic_types"].push_back(type.first);
    if (camera.fstop) facts["fstop"] = json_number(*camera.fstop);
    if (camera.focus_distance) facts["focus"] = json_number(*camera.focus_distance);
    return facts.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::shared_ptr<const TakenPicture> Viewer::taken(const Words &words, const GatherCommand &command,
                                                  Progress &progress) {
    {
        const std::lock_guard lock(last_mutex_);
        if (last_ && last_->words == words) return last_->picture;
    }
    if (command.windows.proxy == 1) { // two at a time would take the memory of one
        const std::lock_guard lock(last_mutex_);
        last_.reset();
    }
    const auto picture = std::make_shared<const TakenPicture>(shot_.taken(command, tool_, progress));
    const std::lock_guard lock(last_mutex_);
    last_ = Last{words, command.windows.proxy, picture};
    return picture;
}

std::string Viewer::answer(const Words &words, const Asked &asked, Progress &progress) {
    const auto begun = std::chrono::steady_clock::now();
    const GatherCommand command = command_of(words);
    const auto picture = taken(words, command, progress);
    progress.may_end();
    const ShownPixels pixels = shot_.displayed(picture->image, asked.exposure);
    Json said = size_of(pixels);
    said["lens"] = lens_facts(*picture, depths_);
    said["milliseconds"] =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    return with_bytes(said, pixels.values);
}

std::optional<std::string> Viewer::picture(const Asked &asked) {
    const Words words = words_of(asked);
    command_of(words); // what is wrong in it is said without waiting
    return studio_.make(asked.page,
                        [this, words, asked](Progress &progress) { return answer(words, asked, progress); });
}

std::optional<std::string> Viewer::reference(const Asked &asked) {
    if (!reference_) throw UsageError("there is no reference: start dof-view with --reference");
    const ShownPixels pixels = shot_.displayed(*reference_, asked.exposure);
    return with_bytes(size_of(pixels), pixels.values);
}

std::optional<std::string> Viewer::rendered(const Asked &asked) {
    const GatherCommand command = command_of(words_with(words_, {{"lens-radius", "0"}}));
    return studio_.make(asked.page + "/rendered", [this, command, asked](Progress &progress) {
        const ShownPixels pixels =
            shot_.displayed(shot_.taken(command, tool_, progress).image, asked.exposure);
        return with_bytes(size_of(pixels), pixels.values);
    });
}

std::string Viewer::objects() const {
    const ObjectMap map = object_map(shot_, names_);
    return with_bytes(map.said, map.numbers);
}

std::string Viewer::samples(const Asked &asked) const {
    if (!asked.pixel) throw UsageError("the request: it says no pixel");
    const GatherCommand command = command_of(words_of(asked));
    const ThinLens lens = shot_.lens(shot_.camera(command));
    Json said{{"samples", sample_facts(shot_, lens, *asked.pixel, names_)}};
    const std::lock_guard lock(last_mutex_);
    if (last_) {
        const Image &image = last_->picture->image;
        const Imath::V2i at = reduced({*asked.pixel, *asked.pixel}, last_->proxy).min;
        if (image.windows.data.intersects(at))
            for (std::size_t k = 0; k < image.channels.size(); ++k)
                said["value"][image.channels[k].name] = json_number(double(image.at(k, at.x, at.y)));
    }
    return said.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string Viewer::progress(const Asked &asked) const {
    Json said{{"finished", studio_.finished()}};
    if (const auto state = studio_.state(asked.page))
        said.update({{"stage", state->stage}, {"percent", state->percent}});
    return said.dump();
}

std::string Viewer::commands(const Asked &asked) const {
    const Words words = words_of(asked);
    command_of(words);
    const std::string output = stem_of(options_.picture.input) + ".png";
    return Json{{"shell", shell_command(words, output)},
                {"python", python_script(words, options_.picture.input, output)}}
        .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::string> Viewer::save(const Asked &asked) {
    if (options_.save.empty()) throw UsageError("nothing can be saved: start dof-view with --save FOLDER");
    const Words words = words_of(asked);
    command_of(words);
    return studio_.make(asked.page + "/save", [this, words](Progress &progress) {
        Image image = taken(words, command_of(words), progress)->image;
        std::filesystem::path path;
        do
            path = std::filesystem::path(options_.save) /
                   fmt::format("{}.{:04}.png", stem_of(options_.picture.input), ++saved_);
        while (std::filesystem::exists(path));
        write_picture(tool_, options_.picture.colour, path.string(), std::move(image), shot_.in().header);
        return Json{{"file", path.string()}}.dump(-1, ' ', false, Json::error_handler_t::replace);
    });
}

} // namespace sparselens
