#include "pictures/edit.h"

#include <ImfFloatAttribute.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <random>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace pictures {

namespace {

std::vector<std::string> split(const std::string &text, char by) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, by);) words.push_back(word);
    return words;
}

double number(const std::string &text) {
    std::size_t end = 0;
    const double value = std::stod(text, &end);
    if (end != text.size()) throw std::invalid_argument(text + " is no number");
    return value;
}

bool contains(const Imath::Box2i &box, int x, int y) { return box.intersects(Imath::V2i(x, y)); }

Channel &channel_to_change(Picture &picture, const std::string &name) {
    for (Channel &c : picture.channels)
        if (c.name == name) return c;
    picture.channels.push_back({name, Imf::FLOAT, std::vector<double>(picture.samples.size())});
    return picture.channels.back();
}

// Sets value(x, y, old) in the window.
void change(Picture &picture, const std::string &name, const Imath::Box2i &where,
            const std::function<double(int, int, double)> &value) {
    Channel &channel = channel_to_change(picture, name);
    std::size_t i = 0;
    for (int y = picture.window().min.y; y <= picture.window().max.y; ++y)
        for (int x = picture.window().min.x; x <= picture.window().max.x; ++x, ++i)
            if (contains(where, x, y)) channel.values[i] = value(x, y, channel.values[i]);
}

void set(Picture &picture, const std::string &name, const std::string &text, const Imath::Box2i &where) {
    if (text.starts_with("noise:")) {
        std::mt19937 random(unsigned(std::stoul(text.substr(6))));
        change(picture, name, where, [&](int, int, double) { return double(random()) / 0x1p32; });
    } else if (const std::size_t dots = text.find(".."); dots != std::string::npos) {
        const double left = number(text.substr(0, dots)), right = number(text.substr(dots + 2));
        const int from = picture.window().min.x, columns = std::max(1, picture.width() - 1);
        change(picture, name, where,
               [&](int x, int, double) { return left + (right - left) * (x - from) / columns; });
    } else {
        change(picture, name, where, [v = number(text)](int, int, double) { return v; });
    }
}

void set_types(Picture &picture, const std::string &names, Imf::PixelType type) {
    for (Channel &c : picture.channels)
        if (names.empty()) c.type = type;
    for (const std::string &name : split(names, ',')) channel_to_change(picture, name).type = type;
}

void choose(Picture &picture, const std::string &names) {
    std::vector<Channel> chosen;
    for (const std::string &name : split(names, ',')) {
        const std::size_t equals = name.find('=');
        chosen.push_back(picture.channel(equals == std::string::npos ? name : name.substr(equals + 1)));
        chosen.back().name = name.substr(0, equals);
    }
    picture.channels = std::move(chosen);
}

void crop(Picture &picture, const Imath::Box2i &window) {
    Picture cut = blank(window);
    cut.header = picture.header;
    cut.header.dataWindow() = window;
    const std::size_t width = std::size_t(picture.width());
    for (const Channel &from : picture.channels) {
        Channel &to = channel_to_change(cut, from.name);
        to.type = from.type;
        std::size_t i = 0;
        for (int y = window.min.y; y <= window.max.y; ++y)
            for (int x = window.min.x; x <= window.max.x; ++x, ++i)
                if (contains(picture.window(), x, y))
                    to.values[i] = from.values[std::size_t(y - picture.window().min.y) * width +
                                               std::size_t(x - picture.window().min.x)];
    }
    picture = std::move(cut);
}

void erase(Picture &picture, const std::string &pattern) {
    const std::regex regex(pattern, std::regex::extended);
    std::vector<std::string> names;
    for (auto a = picture.header.begin(); a != picture.header.end(); ++a) names.push_back(a.name());
    const Imf::Header kept(1, 1); // attributes that every file has
    for (const std::string &name : names)
        if (std::regex_match(name, regex) && kept.find(name) == kept.end() && name != "type" &&
            name != "chunkCount")
            picture.header.erase(name);
}

void set_attribute(Picture &picture, const std::string &text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) throw std::invalid_argument("no value");
    const std::string name = text.substr(0, colon), value = text.substr(colon + 1);
    if (picture.header.find(name) != picture.header.end()) picture.header.erase(name);
    try {
        picture.header.insert(name, Imf::FloatAttribute(float(number(value))));
    } catch (const std::invalid_argument &) {
        picture.header.insert(name, Imf::StringAttribute(value));
    }
}

} // namespace

Imath::Box2i window_of(const std::string &text) {
    int width = 0, height = 0, x = 0, y = 0;
    char by = 0;
    std::istringstream stream(text);
    stream >> width >> by >> height;
    if (!stream || by != 'x' || width < 1 || height < 1) throw std::invalid_argument(text + " is no window");
    if (!stream.eof()) stream >> x >> y;
    if (!stream || !stream.eof()) throw std::invalid_argument(text + " is no window");
    return {{x, y}, {x + width - 1, y + height - 1}};
}

Picture blank(const Imath::Box2i &window) {
    Picture picture{Imf::Header(window, window)};
    picture.header.compression() = Imf::ZIP_COMPRESSION;
    picture.samples.assign(std::size_t(picture.width()) * std::size_t(picture.height()), 1);
    return picture;
}

void edit(Picture &picture, std::span<const std::string> words) {
    const Imath::Box2i everywhere(Imath::V2i(-1 << 28), Imath::V2i(1 << 28));
    Imath::Box2i where = everywhere;
    for (const std::string &word : words) try {
            const std::size_t equals = word.find('=');
            if (equals == std::string::npos || equals == 0) throw std::invalid_argument("no such word");
            const std::string key = word.substr(0, equals), text = word.substr(equals + 1);
            if (key == "fill")
                where = window_of(text);
            else if (key == "all")
                where = everywhere;
            else if (key == "half")
                set_types(picture, text, Imf::HALF);
            else if (key == "float")
                set_types(picture, text, Imf::FLOAT);
            else if (key == "channels")
                choose(picture, text);
            else if (key == "crop")
                crop(picture, window_of(text));
            else if (key == "frame")
                picture.header.displayWindow() = window_of(text);
            else if (key == "erase")
                erase(picture, text);
            else if (key == "set")
                set_attribute(picture, text);
            else if (key.ends_with('*'))
                change(picture, key.substr(0, key.size() - 1), where,
                       [v = number(text)](int, int, double old) { return v * old; });
            else
                set(picture, key, text, where);
        } catch (const std::exception &e) {
            throw std::runtime_error(word + ": " + e.what());
        }
}

} // namespace pictures
