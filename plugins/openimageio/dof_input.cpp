// Reads .dof files as pictures in programs that read by OpenImageIO: dof-view --pipe makes them (docs/openimageio.md).
// The module is loaded by every such program, whatever it reads, so it does nothing before it reads a .dof file, and
// needs no library but the program's OpenImageIO.
#include "picture_level.h"

#include <OpenImageIO/imageio.h>

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

OIIO_PLUGIN_NAMESPACE_BEGIN

namespace {

using sparselens_oiio::Level;

// The file of a name with a query: shot.dof of shot.dof?fstop=2.
std::string file_of(const std::string &name) { return name.substr(0, name.find('?', name.find(".dof"))); }
std::string query_of(const std::string &name) {
    const std::string file = file_of(name);
    return file.size() < name.size() ? name.substr(file.size() + 1) : std::string();
}

class DofInput final : public ImageInput {
public:
    const char *format_name() const override { return "dof"; }

    // Not "procedural": oiiotool 2.4 crashes if such a reader cannot open a file.
    int supports(string_view feature) const override { return feature == "arbitrary_metadata"; }

    bool valid_file(const std::string &name) const override {
        std::error_code unknown;
        const std::string file = file_of(name);
        return file.size() > 4 && file.compare(file.size() - 4, 4, ".dof") == 0 &&
               std::filesystem::is_regular_file(file, unknown);
    }

    // Reads the header only: programs open a file several times before they read its pixels.
    bool open(const std::string &name, ImageSpec &spec) override {
        const std::lock_guard lock(mutex_);
        forget();
        if (!valid_file(name)) return fail(file_of(name) + ": is not a .dof file that can be read");
        return guarded([&] {
            std::error_code unknown;
            source_ = {std::filesystem::absolute(file_of(name), unknown).string(), query_of(name)};
            levels_[0] = sparselens_oiio::read_header(source_, 0);
            m_spec = spec = levels_[0]->spec;
        });
    }

    bool close() override {
        const std::lock_guard lock(mutex_);
        forget();
        return true;
    }

    int current_subimage() const override { return 0; }
    int current_miplevel() const override {
        const std::lock_guard lock(mutex_);
        return current_;
    }

    bool seek_subimage(int subimage, int miplevel) override {
        const std::shared_ptr<const Level> found = level(subimage, miplevel);
        const std::lock_guard lock(mutex_);
        if (!found) return false;
        current_ = miplevel;
        m_spec = found->spec;
        return true;
    }

    ImageSpec spec(int subimage, int miplevel) override {
        const std::shared_ptr<const Level> found = level(subimage, miplevel);
        return found ? found->spec : ImageSpec();
    }
    ImageSpec spec_dimensions(int subimage, int miplevel) override {
        ImageSpec dimensions;
        if (const std::shared_ptr<const Level> found = level(subimage, miplevel))
            dimensions.copy_dimensions(found->spec);
        return dimensions;
    }

    bool read_native_scanline(int subimage, int miplevel, int y, int z, void *data) override {
        return read_native_scanlines(subimage, miplevel, y, y + 1, z, data);
    }

    bool read_native_scanlines(int subimage, int miplevel, int first, int end, int, void *data) override {
        const std::shared_ptr<const Level> of = level(subimage, miplevel);
        if (!of) return fail("there is no such picture");
        return guarded([&] { sparselens_oiio::read_rows(source_, *of, first, end, data); });
    }

    // Programs call it from several threads at the same time.
    bool read_native_tile(int subimage, int miplevel, int x, int y, int, void *data) override {
        const std::shared_ptr<const Level> of = level(subimage, miplevel);
        if (!of || of->spec.tile_width == 0) return fail("there is no such tile");
        return guarded([&] { sparselens_oiio::read_tile(source_, *of, x, y, data); });
    }

private:
    bool fail(const std::string &why) {
        errorfmt("{}", why);
        return false;
    }

    template <typename Work>
    bool guarded(const Work &work) {
        try {
            work();
            return true;
        } catch (const std::exception &error) {
            return fail(error.what());
        }
    }

    // The size of that number; null if there is none. Sizes but the first are asked for when they are needed.
    std::shared_ptr<const Level> level(int subimage, int miplevel) {
        const std::lock_guard lock(mutex_);
        if (subimage != 0 || miplevel < 0 || !levels_[0] || miplevel >= levels_[0]->count) return nullptr;
        std::shared_ptr<const Level> &wanted = levels_[std::size_t(miplevel)];
        if (!wanted) guarded([&] { wanted = sparselens_oiio::read_header(source_, miplevel); });
        return wanted && sparselens_oiio::is_level_of(*levels_[0], *wanted) ? wanted : nullptr;
    }

    void forget() {
        levels_ = {};
        current_ = 0;
    }

    mutable std::mutex mutex_; // for the members below, and the specification
    sparselens_oiio::Source source_;
    std::array<std::shared_ptr<const Level>, sparselens_oiio::most_levels> levels_;
    int current_ = 0;
};

} // namespace

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT int dof_imageio_version = OIIO_PLUGIN_VERSION;
OIIO_EXPORT const char *dof_imageio_library_version() { return "sparselens " SPARSELENS_VERSION; }
OIIO_EXPORT ImageInput *dof_input_imageio_create() { return new DofInput; }
OIIO_EXPORT const char *dof_input_extensions[] = {"dof", nullptr};

OIIO_PLUGIN_EXPORTS_END

OIIO_PLUGIN_NAMESPACE_END
