#include "picture_level.h"

#include "../client/json_answer.h"

#include <OpenImageIO/filesystem.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace sparselens_oiio {

namespace {

using Json = nlohmann::json;
using Answer = sparselens_client_cpp::JsonAnswer;
using OIIO::ImageSpec;

constexpr std::size_t most_bytes = 4 << 20; // of pixels at a time

// It lives as long as the program: other threads may still read while the program ends.
sparselens_client *client() {
    static sparselens_client *const one = sparselens_client_cpp::client_beside(
        reinterpret_cast<const void *>(&client), SPARSELENS_BIN_FROM_HERE);
    return one;
}

Json request(const char *what, const Source &source, int level) {
    return {{"ask", what}, {"file", source.file}, {"query", source.query}, {"level", level}};
}

// What OpenImageIO's own reader of EXR says of these bytes, so that channels and metadata are those of the file that
// dof-gather writes.
ImageSpec spec_of_exr(const Answer &answer) {
    OIIO::Filesystem::IOMemReader memory(answer.bytes(), answer.size());
    const auto exr = OIIO::ImageInput::open("header.exr", nullptr, &memory);
    if (!exr) throw std::runtime_error("the header of the picture: " + OIIO::geterror());
    return exr->spec();
}

struct Box {
    int x0, y0, x1, y1; // the last pixels are not included
    std::size_t width() const { return std::size_t(x1 - x0); }
    std::size_t height() const { return std::size_t(y1 - y0); }
};

Answer ask_for_pixels(const Source &source, const Level &level, const Box &box) {
    Json tile = request("tile", source, level.number);
    tile["box"] = {box.x0, box.y0, box.x1 - 1, box.y1 - 1};
    tile["channels"] = level.spec.channelnames;
    return Answer(client(), tile);
}

void require_size(const Answer &answer, const Level &level, const Box &box) {
    if (answer.size() != box.width() * box.height() * level.spec.pixel_bytes(true))
        throw std::runtime_error("the picture has changed: open it again");
}

} // namespace

std::shared_ptr<const Level> read_header(const Source &source, int number) {
    const Answer answer(client(), request("header", source, number));
    const Json said = answer.said();
    auto level = std::make_shared<Level>();
    level->number = number;
    level->spec = spec_of_exr(answer);
    ImageSpec &spec = level->spec;
    const auto data = said.at("data").get<std::vector<int>>();
    spec.x = data.at(0);
    spec.y = data.at(1);
    spec.width = data.at(2) - spec.x + 1;
    spec.height = data.at(3) - spec.y + 1;
    if (spec.tile_width > 0) level->count = std::clamp(said.at("levels").get<int>(), 1, int(most_levels));
    if (level->count > 1) { // what OpenImageIO says of an EXR file with MIP levels
        spec.attribute("textureformat", "Plain Texture");
        spec.attribute("openexr:roundingmode", 1);
    }
    return level;
}

bool is_level_of(const Level &full, const Level &level) {
    const auto is_part = [&](int whole, int part) {
        const int pixels = 1 << level.number;
        return part == (whole + pixels - 1) / pixels;
    };
    return is_part(full.spec.width, level.spec.width) && is_part(full.spec.height, level.spec.height);
}

void read_rows(const Source &source, const Level &level, int first, int end, void *data) {
    const ImageSpec &spec = level.spec;
    const std::size_t row = std::size_t(spec.width) * spec.pixel_bytes(true);
    const int at_once = int(std::max<std::size_t>(most_bytes / row, 1));
    auto *to = static_cast<char *>(data);
    for (int y = first; y < end; y += at_once) {
        const Box box{spec.x, y, spec.x + spec.width, std::min(end, y + at_once)};
        const Answer answer = ask_for_pixels(source, level, box);
        require_size(answer, level, box);
        std::memcpy(to, answer.bytes(), answer.size());
        to += answer.size();
    }
}

void read_tile(const Source &source, const Level &level, int x, int y, void *data) {
    const ImageSpec &spec = level.spec;
    const std::size_t pixel = spec.pixel_bytes(true);
    const Box box{x, y, std::min(x + spec.tile_width, spec.x + spec.width),
                  std::min(y + spec.tile_height, spec.y + spec.height)};
    const Answer answer = ask_for_pixels(source, level, box);
    require_size(answer, level, box);
    std::memset(data, 0, std::size_t(spec.tile_width) * std::size_t(spec.tile_height) * pixel);
    for (std::size_t line = 0; line < box.height(); ++line)
        std::memcpy(static_cast<char *>(data) + line * std::size_t(spec.tile_width) * pixel,
                    static_cast<const char *>(answer.bytes()) + line * box.width() * pixel,
                    box.width() * pixel);
}

} // namespace sparselens_oiio
