#include "asked.h"

#include "../client/json_answer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <stdexcept>

namespace sparselens_ofx {

namespace {

using Json = nlohmann::json;
using Answer = sparselens_client_cpp::JsonAnswer;

std::mutex client_mutex;
sparselens_client *the_client = nullptr;

sparselens_client *client() {
    const std::lock_guard lock(client_mutex);
    if (!the_client)
        the_client = sparselens_client_cpp::client_beside(reinterpret_cast<const void *>(&client),
                                                          SPARSELENS_BIN_FROM_HERE);
    return the_client;
}

Json json_of(const Box &box) { return {box.x0, box.y0, box.x1, box.y1}; }

Box box_in(const Json &said, const char *name) {
    const auto numbers = said.at(name).get<std::array<int, 4>>();
    return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

Answer ask(const char *what, const Question &question, Json more) {
    Json request = std::move(more);
    request.update({{"ask", what},
                    {"frame", question.frame},
                    {"shown", question.shown},
                    {"settings", question.settings}});
    if (!question.flat) {
        request["file"] = question.file;
        return Answer(client(), request);
    }
    const FlatPicture &flat = *question.flat;
    request["picture"] = {{"display", json_of(flat.display)},
                          {"data", json_of(flat.data)},
                          {"pixel_aspect", flat.pixel_aspect},
                          {"channels", flat.channels},
                          {"shown", flat.shown}};
    return Answer(client(), request, flat.pixels.data(), flat.pixels.size() * sizeof(float));
}

} // namespace

Header ask_header(const Question &question) {
    const Json said = ask("header", question, Json::object()).said();
    Header header{box_in(said, "display"), box_in(said, "data"), {}};
    for (const Json &channel : said.at("channels")) header.channels.push_back(channel.at("name"));
    return header;
}

std::vector<float> ask_pixels(const Question &question, const Header &header, const Box &box) {
    std::vector<std::string> channels{"R", "G", "B"};
    if (std::ranges::find(header.channels, "A") != header.channels.end()) channels.emplace_back("A");
    const Answer answer = ask("tile", question, {{"box", json_of(box)}, {"channels", channels}});
    const std::size_t count = std::size_t(box.x1 - box.x0 + 1) * std::size_t(box.y1 - box.y0 + 1);
    const std::size_t stored = channels.size() * sizeof(float);
    if (answer.size() != count * stored) throw std::runtime_error("the picture has changed: render again");
    std::vector<float> pixels(4 * count, 1.0f);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&pixels[4 * i], static_cast<const char *>(answer.bytes()) + i * stored, stored);
    return pixels;
}

void stop_asking() {
    const std::lock_guard lock(client_mutex);
    sparselens_client_free(the_client);
    the_client = nullptr;
}

} // namespace sparselens_ofx
