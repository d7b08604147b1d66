// An EXR file of a stream, opened so that it says nothing itself: OpenEXR 3.4 prints lines about damaged files to stderr beside
// what it throws. Throws what OpenEXR throws.
#pragma once

#include <ImfMultiPartInputFile.h>
#include <OpenEXRConfig.h>

#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 4
#include <ImfContextInit.h>
#endif

namespace sparselens {

inline Imf::MultiPartInputFile open_exr(Imf::IStream &stream) {
#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 4
    // As lenient as for a stream alone.
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
