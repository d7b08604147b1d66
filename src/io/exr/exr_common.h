// Functions that the flat and the deep EXR code share. Not for use outside io/.
#pragma once

#include "base/error.h"
#include "base/image.h"
#include "io/exr/exr_header.h"
#include "io/exr/exr_parts.h"
#include "io/files/file_stream.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPixelType.h>
#include <OpenEXRConfig.h>

#include <map>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

Windows windows_of(const Imf::Header &header);

// The memory, in bytes, of a picture with `values` floats per pixel and of one tile of its file.
double memory_of(const Imf::Header &header, std::size_t values);

// The names, separated by commas. If there are many: the first ones, and the number of the others.
std::string first_of(const std::vector<std::string> &names);

// Whether the channel holds the position or weight of a sample in our files: Z, ZBack, ldi.dx, ldi.dy,
// ldi.weight, ldi.optical or ldi.solid.
// Such a channel is never carried along like a colour.
bool is_position_channel(const std::string &channel);

// A new header with these windows and channels. It keeps all of `metadata` except the description of how its own pixels
// were stored.
Imf::Header output_header(const Windows &windows, std::span<const Channel> channels,
                          const Imf::Header &metadata);

Imf::PixelType imf_type(PixelType type);
std::size_t bytes_of(PixelType type);

// Stores `count` floats of `from` in the type of the channel to `to`, on all threads. Finite values beyond the range of
// half become the largest half, never infinity. Returns the number of such values.
std::size_t store(PixelType type, const float *from, std::size_t count, char *to);

// Calls work() and turns exceptions of OpenEXR into an Error that names the file.
template <typename Work>
auto with_file_name(const std::string &path, const Work &work) {
    try {
        return work();
    } catch (const Error &) {
        throw;
    } catch (const UsageError &) {
        throw;
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &error) {
        const std::string name = display_name(path), what = error.what();
        throw Error(what.find(name) == std::string::npos ? name + ": " + what : what);
    }
}

// The Cryptomattes that headers name (base/matte.h). Not for use outside io/.

// The attributes cryptomatte/.../name.
std::vector<std::string> matte_names(const Imf::Header &header);

// The header with the attributes cryptomatte/... of all parts, because mattes may lie in their own parts.
Imf::Header with_mattes_of(const Imf::MultiPartInputFile &file, Imf::Header header);

// The header, in which attributes state the kinds that the choice gives to channels. Later steps read them there.
// Throws Error if the choice names something that is not among the channels.
Imf::Header with_stated_kinds(Imf::Header header, const PictureChoice &choice,
                              std::span<const Channel> channels, const std::string &path);

// Sets the kinds of channels (base/channel_kind.h) by their names, and by the mattes and kinds that the header states.
void find_kinds_by(const Imf::Header &header, std::span<Channel> channels);
void find_kinds_by(const Imf::Header &header, std::vector<FileChannel> &channels);

// Files keep the names of their channels. If the code knows a channel by another name (base/channel_kind.h: red is R),
// an attribute of the header in memory records its name in files. The attribute is never written; in files the channels
// have their own names. Not for use outside io/ and python/.

inline constexpr const char *kept_names_attribute = "sparselens:channelNames";

using KeptNames = std::map<std::string, std::string>; // R: red

void set_kept_names(Imf::Header &header, const KeptNames &names);

// Gives channels the names by which the code knows them, and records their original names in the header.
void name_colours(std::span<Channel> channels, Imf::Header &header);

// The channels by their names in a file with this metadata. All names are different.
std::vector<Channel> by_kept_names(std::span<const Channel> channels, const Imf::Header &metadata);

} // namespace sparselens

#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR >= 4
#include <ImfContextInit.h>
#endif

namespace sparselens {

// Opens an EXR file in a stream without output: OpenEXR 3.4 otherwise prints lines about damaged files to stderr in
// addition to throwing. Throws what OpenEXR throws.
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

// Calls work(file, stream) with the EXR file of that name, whose headers are checked. Throws Error, naming the file.
template <typename Work>
auto with_exr(const std::string &path, const Work &work) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        Imf::MultiPartInputFile file = open_exr(*stream);
        return work(file, *stream);
    });
}

} // namespace sparselens
