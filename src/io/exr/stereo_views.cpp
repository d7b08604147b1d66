#include "io/exr/stereo_views.h"

#include "base/text.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_header_check.h"
#include "io/exr/exr_parts.h"
#include "io/files/file_stream.h"

#include <ImfMultiPartInputFile.h>

namespace sparselens {

std::vector<std::string> stereo_views(const std::string &path) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        const Imf::MultiPartInputFile file(*stream);
        std::vector<std::string> views;
        for (int part = 0; part < file.parts(); ++part)
            for (const std::string &view : views_of(file.header(part)))
                if (!is_among(views, view)) views.push_back(view);
        return views;
    });
}

} // namespace sparselens
