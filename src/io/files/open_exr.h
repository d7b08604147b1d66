// Opens an EXR file in a stream without output: OpenEXR 3.4 otherwise prints lines about damaged files to stderr in
// addition to throwing. Throws what OpenEXR throws.
#pragma once

#include <ImfMultiPartInputFile.h>
#include <OpenEXRConfig.h>

#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 4
#include <ImfContextInit.h>
#endif

namespace sparselens {

inline Imf::MultiPartInputFile open_exr(Imf::IStream &stream) {
#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 4
    // As lenient as when only a stream is passed.
    return Imf::MultiPartInputFile(
        stream.fileName(), Imf::ContextInitializer()
                               .setErrorHandler([](exr_const_context_t, exr_result_t, const char *) {})
                               .silentHeaderParse(true)
                               .strictHeaderValidation(false)
                               .setInputStream(&stream));
#else
    return Imf::MultiPartInputFile(stream);
#endif
}

} // namespace sparselens
