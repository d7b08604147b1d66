#include "io/exr/exr_mattes.h"

#include <ImfStringAttribute.h>

namespace sparselens {

namespace {
constexpr const char *prefix = "cryptomatte/";
} // namespace

std::vector<std::string> matte_names(const Imf::Header &header) {
    std::vector<std::string> names;
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string name = it.name();
        const auto *text = dynamic_cast<const Imf::StringAttribute *>(&it.attribute());
        if (text && name.starts_with(prefix) && name.ends_with("/name")) names.push_back(text->value());
    }
    return names;
}

Imf::Header with_mattes_of(const Imf::MultiPartInputFile &file, Imf::Header header) {
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header &other = file.header(part);
        for (auto it = other.begin(); it != other.end(); ++it)
            if (std::string(it.name()).starts_with(prefix) && header.find(it.name()) == header.end())
                header.insert(it.name(), it.attribute());
    }
    return header;
}

void find_kinds_by(const Imf::Header &header, std::span<Channel> channels) {
    find_kinds(channels, matte_names(header));
}

void find_kinds_by(const Imf::Header &header, std::vector<FileChannel> &channels) {
    std::vector<Channel> plain;
    for (const FileChannel &found : channels) plain.push_back(found.channel);
    find_kinds_by(header, plain);
    for (std::size_t k = 0; k < channels.size(); ++k) channels[k].channel = plain[k];
}

} // namespace sparselens
