// Functions that the flat and the deep EXR code share. Not for use outside io/.
#pragma once

#include "base/error.h"
#include "base/image.h"
#include "io/files/file_stream.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfPixelType.h>

#include <span>
#include <string>

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

} // namespace sparselens
