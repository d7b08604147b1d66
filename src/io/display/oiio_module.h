// OpenImageIO's writers as a module that is loaded when a picture for them is to be written, and not before: its two
// hundred libraries take longer to load than most pictures take to gather.
//
// A C interface: no exception and no object crosses it.
#pragma once

namespace sparselens {

struct OiioPicture {
    const char *path;
    void *source;
    const float *(*row)(void *source, int y); // of `source`, from the top: pixel by pixel, channels together
    int width, height;
    int channels;       // 3, or 4 with unassociated alpha
    int bits;           // 8 or 16
    float pixel_aspect; // width over height
};

struct OiioModule {
    enum class Support { none, opaque, alpha };

    // What the format that goes by this extension (png, without the dot) can be written with.
    Support (*support)(const char *extension);
    // Null, or what went wrong: valid until the thread calls again.
    const char *(*write)(const OiioPicture &picture);
};

inline constexpr const char *oiio_module_entry = "sparselens_oiio_module";

// Loaded at the first call, from beside the program (../lib/sparselens), else from where it was to be installed.
// Throws Error where it is not found or cannot be loaded.
const OiioModule &oiio_module();

} // namespace sparselens
