// What the flat and the deep EXR code share. Not for use outside io/.
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

// What a picture takes in memory that holds `values` floats a pixel, and one tile of its file (bytes).
double memory_of(const Imf::Header &header, std::size_t values);

// The name of the depth channel: `asked`, or where that is empty Z, depth.Z or *.Depth.Z. Error where there is
// none, or where it holds integers.
std::string find_depth_channel(const std::vector<Channel> &channels, const std::string &asked,
                               const std::string &path);

// Whether there is one, of whatever type.
bool has_depth_channel(const std::vector<Channel> &channels, const std::string &asked);

// Whether the channel says where a sample lies, in our files: Z, ZBack, ldi.dx, ldi.dy or ldi.weight. Such a
// channel is never carried along as if it were a colour.
bool is_position_channel(const std::string &channel);

// A fresh header with these windows and channels that keeps all of `metadata` that does not describe how its
// own pixels were stored.
Imf::Header output_header(const Windows &windows, std::span<const Channel> channels,
                          const Imf::Header &metadata);

Imf::PixelType imf_type(PixelType type);
std::size_t bytes_of(PixelType type);

// Stores floats as the channel's type, `count` values from `from` to `to`. Finite values beyond half's range
// become its largest, never infinity; returns how many there were.
std::size_t store(PixelType type, const float *from, std::size_t count, char *to);

// Calls work(); what OpenEXR throws leaves as Error that names the file.
template <typename Work>
auto with_file_name(const std::string &path, const Work &work) {
    try {
        return work();
    } catch (const Error &) {
        throw;
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &error) {
        const std::string name = display_name(path), what = error.what();
        throw Error(what.find(name) == std::string::npos ? name + ": " + what : what);
    }
}

} // namespace sparselens
