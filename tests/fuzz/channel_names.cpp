// Any lines as the channels of a file and the attributes that name Cryptomattes: finds each channel's kind, the mattes,
// the beauty, the depth. "h NAME", "f NAME" and "u NAME" are channels of half, float and uint; other lines are
// attributes.
#include "base/matte.h"
#include "fuzz/fuzz.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_parts.h"

#include <ImfStringAttribute.h>

#include <sstream>
#include <vector>

using namespace sparselens;

namespace {

void read_line(Imf::Header &header, const std::string &line) {
    if (line.size() > 2 && line[1] == ' ') {
        const auto type = line[0] == 'h' ? Imf::HALF : line[0] == 'u' ? Imf::UINT : Imf::FLOAT;
        header.channels().insert(line.substr(2), Imf::Channel(type));
    } else {
        header.insert("cryptomatte/" + line.substr(0, 7) + "/name", Imf::StringAttribute(line));
    }
}

void check_mattes(const std::vector<Channel> &channels) {
    for (const Matte &matte : find_mattes(channels))
        for (const Matte::Rank &rank : matte.ranks)
            if (channels[rank.id].kind != ChannelKind::matte_id ||
                channels[rank.coverage].kind != ChannelKind::matte_coverage ||
                channels[rank.id].matte != matte.name ||
                channels[rank.id].rank != channels[rank.coverage].rank)
                __builtin_trap();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    std::istringstream in{std::string(fuzz::text_of(data, size))};
    Imf::Header header(64, 48);
    for (std::string line; std::getline(in, line);) fuzz::may_fail([&] { read_line(header, line); });
    for (const char *view : {"", "left"})
        fuzz::may_fail([&] {
            std::vector<FileChannel> found = channels_of(header, view, "fuzz");
            find_kinds_by(header, found);
            std::vector<Channel> channels;
            for (const FileChannel &channel : found) channels.push_back(channel.channel);
            check_mattes(channels);
            beauty_warnings(channels);
            const std::vector<PictureLayer> pictures = pictures_in(channels);
            if (!pictures.empty()) {
                const ChannelsOfPicture last(pictures.back(), channels);
                for (const Channel &channel : channels) last.name_of(channel.name);
                name_beauty(found, pictures.front().beauty, channels);
            }
            find_depth_channel(channels, "", "fuzz");
        });
    return 0;
}
