#include "io/exr/picture_choice.h"

#include "io/exr/exr_common.h"
#include "io/exr/exr_header_check.h"
#include "io/exr/exr_parts.h"
#include "io/files/file_stream.h"

#include <ImfMultiPartInputFile.h>

#include <numeric>

namespace sparselens {

std::vector<std::string> stereo_views(const std::string &path) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        const Imf::MultiPartInputFile file(*stream);
        std::vector<int> parts(std::size_t(file.parts()));
        std::iota(parts.begin(), parts.end(), 0);
        return all_views(file, parts);
    });
}

} // namespace sparselens
