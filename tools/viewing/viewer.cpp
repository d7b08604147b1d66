#include "viewing/viewer.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "chain/match_lens.h"
#include "io/moment_files.h"
#include "options/match_options.h"
#include "viewing/frame_cache.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace sparselens {

namespace {

using Json = nlohmann::json;

std::string with_bytes(const Json &said, const std::vector<std::uint8_t> &bytes) {
    // Text from a file or a message may not be UTF-8.
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

// The name of its file, without the placeholder of moments.
std::string file_name(const std::string &input) {
    const std::string name = input == "-" ? "picture" : std::filesystem::path(input).filename().string();
    return names_moments(input) ? without_moment(name) : name;
}

std::string stem_of(const std::string &input) {
    return std::filesystem::path(file_name(input)).stem().stem().string();
}

// The name of a file or sequence of pictures made from `input`; it differs from it by "dof", placed before the frame's
// number if there is one.
std::string output_name(const std::string &input, const std::string &ending) {
    std::string name = file_name(input);
    for (const std::string_view last : {".exr", ".ldi"})
        if (name.ends_with(last) && name.size() > last.size()) name.resize(name.size() - last.size());
    const std::size_t dot = name.rfind('.');
    const bool numbered = dot != std::string::npos && dot + 1 < name.size() &&
                          name.find_first_not_of("0123456789#@%dF$-", dot + 1) == std::string::npos;
    return name.substr(0, numbered ? dot : std::string::npos) + ".dof" + (numbered ? name.substr(dot) : "") +
           ending;
}

std::vector<GatherCommand> commands_of(const FrameCommands &frames) {
    std::vector<GatherCommand> commands;
    for (std::size_t i = 0; i < frames.size(); ++i)
        commands.push_back(command_of(picture_words(frames.words(i))));
    return commands;
}

} // namespace

Viewer::Viewer(const ViewOptions &options, const Words &words, const FrameCommands &frames,
               const ToolContext &tool)
    : options_(options), words_(picture_words(words)), frames_(frames), tool_(tool),
      sequence_(commands_of(frames), tool) {
    const FrameCache::Held first = sequence_.frame(options.picture);
    photograph_ = first->in.depth == DepthMeaning::disparity;
    if (!photograph_) guess_ = lens_guess(*first, first->camera(options.picture));
    if (!guess_.empty()) warn(tool, guess_in_words(guess_));
    words_.insert(words_.end(), guess_.begin(), guess_.end());
    const auto is_there = [](const Image &) {};
    if (!options.reference.empty()) reference_.with(options.reference, is_there);
    if (!options.plate.empty()) plate_.with(options.plate, is_there);
    if (!options.save.empty() && !std::filesystem::is_directory(options.save))
        throw Error(options.save + ": is not a folder (--save)");
}

std::size_t Viewer::frame_of(const PageRequest &wanted) const {
    if (!wanted.frame) return 0;
    for (std::size_t i = 0; frames_.is_range() && i < frames_.size(); ++i)
        if (frames_.number(i) == *wanted.frame) return i;
    throw UsageError(fmt::format("the request: there is no frame {}", *wanted.frame));
}

Words Viewer::words_of_frame(std::size_t i) const {
    Words words = picture_words(frames_.words(i));
    words.insert(words.end(), guess_.begin(), guess_.end());
    return words;
}

Words Viewer::words_of(const PageRequest &wanted) const {
    return words_with(words_of_frame(frame_of(wanted)), wanted.settings, options_.presets);
}

GatherCommand Viewer::command_of_frame(const PageRequest &wanted) const {
    return command_of(words_of_frame(frame_of(wanted)));
}

std::string Viewer::facts(const PageRequest &wanted) {
    const GatherCommand command = command_of_frame(wanted);
    const FrameCache::Held frame = sequence_.frame(command);
    const Windows &windows = frame->in.ldi.windows;
    const Imath::Box2i display = reduced(windows.display, frame->across);
    const Camera camera = frame->camera(command);
    Json facts{{"name", stem_of(command.input)},
               {"file", frame->in.name},
               {"min", {display.min.x, display.min.y}},
               {"width", display.max.x - display.min.x + 1},
               {"height", display.max.y - display.min.y + 1},
               {"pixel_aspect", windows.pixel_aspect},
               {"samples", frame->packed.samples()},
               {"lens_method", command.picture.method->by_lens_points},
               {"looks", look_controls(options_.presets)},
               {"reference", !options_.reference.empty()},
               {"plate", !options_.plate.empty()},
               {"save", !options_.save.empty()},
               {"objects", !frame->names.empty()},
               {"nearest", finite_json(frame->depths.nearest)},
               {"farthest", finite_json(frame->depths.farthest)}};
    for (std::size_t i = 0; frames_.is_range() && i < frames_.size(); ++i)
        facts["frames"].push_back(frames_.number(i));
    if (!guess_.empty()) facts["guess"] = guess_in_words(guess_);
    if (camera.metres_per_unit) facts["metres_per_unit"] = *camera.metres_per_unit;
    if (photograph_)
        facts["blur"] = command.blur.value_or(PhotographBlur()).in_pixels(windows.display_width());
    if (camera.fstop) facts["fstop"] = finite_json(*camera.fstop);
    if (camera.focus_distance) facts["focus"] = finite_json(*camera.focus_distance);
    return facts.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::shared_ptr<const SequencePicture> Viewer::taken(const Words &words, const GatherCommand &command,
                                                     Progress &progress, const TileWatch *watch) {
    {
        const std::lock_guard lock(last_mutex_);
        if (last_ && last_->words == words) return last_->picture;
    }
    if (command.windows.proxy == 1) { // frees the last picture first: two would take twice the memory
        const std::lock_guard lock(last_mutex_);
        last_.reset();
    }
    const auto picture =
        std::make_shared<const SequencePicture>(sequence_.taken(command, tool_, progress, watch));
    const std::lock_guard lock(last_mutex_);
    last_ = LastPicture{words, command.windows.proxy, picture};
    return picture;
}

std::string Viewer::answer(const Words &words, const PageRequest &wanted, Progress &progress) {
    const auto begun = std::chrono::steady_clock::now();
    const GatherCommand command = command_of(words);
    const FrameCache::Held frame = sequence_.frame(command);
    const TileWatch watch{
        wanted.pixel.value_or(Imath::V2i(0)),
        [&](const Image &picture, const Imath::Box2i &tile) { add_piece(wanted, *frame, picture, tile); }};
    const Pieces::AtWork at_work(pieces_, wanted.page);
    const auto picture = taken(words, command, progress, wanted.pixel ? &watch : nullptr);
    progress.may_end();
    const ShownPixels pixels = Sequence::displayed(picture->image, wanted.exposure, *frame);
    Json said = size_of(pixels);
    said["lens"] = lens_facts(*picture);
    if (!picture->device.empty()) said["device"] = picture->device;
    said["milliseconds"] =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    return with_bytes(said, pixels.values);
}

// Adds the part of the tile that is displayed.
void Viewer::add_piece(const PageRequest &wanted, const LoadedFrame &frame, const Image &picture,
                       const Imath::Box2i &tile) {
    const Imath::Box2i box = common_box(tile, picture.windows.display);
    if (box.isEmpty()) return;
    Image piece = crop(picture, box);
    piece.windows.display = box;
    pieces_.add({box.min, Sequence::displayed(std::move(piece), wanted.exposure, frame)});
}

std::string Viewer::pieces(const PageRequest &wanted) {
    Json said{{"pieces", Json::array()}};
    std::vector<std::uint8_t> bytes;
    for (const Piece &piece : pieces_.take(wanted.page)) {
        Json place = size_of(piece.pixels);
        place.update({{"x", piece.first.x}, {"y", piece.first.y}});
        said["pieces"].push_back(place);
        bytes.insert(bytes.end(), piece.pixels.values.begin(), piece.pixels.values.end());
    }
    return with_bytes(said, bytes);
}

std::optional<std::string> Viewer::picture(const PageRequest &wanted) {
    const Words words = words_of(wanted);
    command_of(words); // reports errors without waiting
    return queue_.make(wanted.page,
                       [this, words, wanted](Progress &progress) { return answer(words, wanted, progress); });
}

std::string Viewer::file_of(const PageRequest &wanted, const char *option) const {
    const std::string path = value_of(option, frames_.words(frame_of(wanted)));
    if (path.empty())
        throw UsageError(fmt::format("there is no {}: start dof-view with {}", option + 2, option));
    return path;
}

std::string Viewer::beside(const PageRequest &wanted, const char *option, LoadedPicture &file) {
    const std::string path = file_of(wanted, option);
    const FrameCache::Held frame = sequence_.frame(command_of_frame(wanted));
    return file.with(path, [&](const Image &image) {
        const ShownPixels pixels = Sequence::displayed(image, wanted.exposure, *frame);
        return with_bytes(size_of(pixels), pixels.values);
    });
}

std::optional<std::string> Viewer::reference(const PageRequest &wanted) {
    return beside(wanted, "--reference", reference_);
}
std::optional<std::string> Viewer::plate(const PageRequest &wanted) {
    return beside(wanted, "--plate", plate_);
}

std::optional<std::string> Viewer::match(const PageRequest &wanted) {
    const std::string path = file_of(wanted, "--plate");
    const GatherCommand shot = command_of_frame(wanted), shown = command_of(words_of(wanted));
    return queue_.make(wanted.page + "/match", [=, this](Progress &progress) {
        const FrameCache::Held frame = sequence_.frame(shot);
        OpenedLdi in = frame->unpacked();
        in.camera.supersample = frame->across;
        const MatchRequest request{.region = wanted.region, .lens = shot.lens, .looks = shown.looks};
        const MatchedLens lens = plate_.with(
            path, [&](const Image &plate) { return match_lens(in, plate, path, request, progress); });
        if (!lens.doubt.empty()) throw Error(path + ": " + lens.doubt);
        return as_json(lens).dump();
    });
}

std::optional<std::string> Viewer::rendered(const PageRequest &wanted) {
    PageRequest sharp = wanted;
    sharp.settings = {{photograph_ ? "blur" : "lens-radius", "0"}};
    const GatherCommand command = command_of(words_of(sharp));
    return queue_.make(wanted.page + "/rendered", [this, command, wanted](Progress &progress) {
        const ShownPixels pixels = Sequence::displayed(sequence_.taken(command, tool_, progress).image,
                                                       wanted.exposure, *sequence_.frame(command));
        return with_bytes(size_of(pixels), pixels.values);
    });
}

std::string Viewer::objects(const PageRequest &wanted) {
    const ObjectMap map = object_map(*sequence_.frame(command_of_frame(wanted)));
    return with_bytes(map.said, map.numbers);
}

std::string Viewer::samples(const PageRequest &wanted) {
    if (!wanted.pixel) throw UsageError("the request: it says no pixel");
    const GatherCommand command = command_of(words_of(wanted));
    const FrameCache::Held frame = sequence_.frame(command);
    Json said{{"samples", sample_facts(*frame, frame->lens(command), *wanted.pixel)}};
    const std::lock_guard lock(last_mutex_);
    if (last_ && std::ranges::find(last_->words, command.input) != last_->words.end()) {
        const Image &image = last_->picture->image;
        const Imath::V2i at = reduced({*wanted.pixel, *wanted.pixel}, last_->proxy).min;
        if (image.windows.data.intersects(at))
            for (std::size_t k = 0; k < image.channels.size(); ++k)
                said["value"][image.channels[k].name] = finite_json(double(image.at(k, at.x, at.y)));
    }
    return said.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string Viewer::progress(const PageRequest &wanted) const {
    Json said{{"finished", queue_.finished()}, {"held", sequence_.frames().held()}};
    if (const auto state = queue_.state(wanted.page))
        said.update({{"stage", state->stage}, {"percent", state->percent}});
    return said.dump();
}

std::string Viewer::commands(const PageRequest &wanted) const {
    const std::string ending = "." + wanted.format;
    const std::string input = command_of(words_of(wanted)).input, output = output_name(input, ending);
    const auto shown = [&](const Words &all) {
        return words_for(all, output, photograph_ ? "final" : "normal");
    };
    const Words words = shown(words_of(wanted));
    // The input of all frames is the word of words_ at the index that the first frame's input has in its own words.
    const Words first = picture_words(frames_.words(0));
    std::string range = words_[std::size_t(std::ranges::find(first, options_.picture.input) - first.begin())];
    range = output_name(range, file_at(range, 1) == range ? ".####" + ending : ending);
    return Json{{"shell", shell_command(words, output)},
                {"range", shown(words_with(words_, wanted.settings, options_.presets))},
                {"range_output", range},
                {"python", python_script(words, input, output)}}
        .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::string> Viewer::save(const PageRequest &wanted) {
    if (options_.save.empty()) throw UsageError("nothing can be saved: start dof-view with --save FOLDER");
    const Words words = words_of(wanted);
    command_of(words);
    return queue_.make(wanted.page + "/save", [this, words](Progress &progress) {
        const GatherCommand command = command_of(words);
        Image image = taken(words, command, progress)->image;
        std::filesystem::path path;
        do
            path = std::filesystem::path(options_.save) /
                   fmt::format("{}.{:04}.png", stem_of(command.input), ++saved_);
        while (std::filesystem::exists(path));
        write_picture(tool_.notify(), command.colour, path.string(), std::move(image),
                      sequence_.frame(command)->in.header);
        return Json{{"file", path.string()}}.dump(-1, ' ', false, Json::error_handler_t::replace);
    });
}

} // namespace sparselens
