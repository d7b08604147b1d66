#include "io/exr/picture_choice.h"

#include "io/exr/exr_beauty.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_header_check.h"
#include "io/exr/exr_parts.h"
#include "io/files/file_stream.h"

#include <ImfMultiPartInputFile.h>

#include <numeric>

namespace sparselens {

namespace {

// The result of find(file, numbers of its parts) on the headers.
template <typename Find>
auto in_headers(const std::string &path, const Find &find) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        const Imf::MultiPartInputFile file(*stream);
        std::vector<int> parts(std::size_t(file.parts()));
        std::iota(parts.begin(), parts.end(), 0);
        return find(file, parts);
    });
}

} // namespace

std::vector<std::string> stereo_views(const std::string &path) {
    return in_headers(path, [](const auto &file, const auto &parts) { return all_views(file, parts); });
}

std::vector<std::string> picture_layers(const std::string &path, const std::string &stereo_view) {
    return in_headers(path, [&](const auto &file, const auto &parts) {
        const PartsOfView of_view = parts_of_view(file, parts, stereo_view, path);
        std::vector<std::string> names;
        for (const PictureLayer &picture :
             pictures_in(full_channels(file, of_view.numbers, of_view.view, path)))
            names.push_back(picture.name);
        return names;
    });
}

} // namespace sparselens
