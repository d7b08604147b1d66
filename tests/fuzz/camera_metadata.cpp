// Any values and texts as the camera in a header: read, resolved to a lens, written, read again.
#include "fuzz/fuzz.h"
#include "io/camera/camera_header.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <ImfBoxAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>

#include <array>
#include <cstring>

using namespace sparselens;

namespace {

// Takes values from the bytes, and zeros after the end.
class Bytes {
public:
    Bytes(const std::uint8_t *data, std::size_t size) : data_(data), size_(size) {}
    template <typename Value>
    Value take() {
        Value value{};
        const std::size_t count = std::min(sizeof value, size_);
        std::memcpy(&value, data_, count);
        data_ += count;
        size_ -= count;
        return value;
    }
    std::string text(std::size_t longest) {
        const std::size_t count = std::min(longest, size_);
        const std::string value(reinterpret_cast<const char *>(data_), count);
        data_ += count;
        size_ -= count;
        return value;
    }

private:
    const std::uint8_t *data_;
    std::size_t size_;
};

template <typename Scalar>
Imath::Matrix44<Scalar> take_matrix(Bytes &bytes) {
    Imath::Matrix44<Scalar> matrix; // near the identity in most cases
    const auto changed = bytes.take<std::uint16_t>();
    for (int i = 0; i < 16; ++i)
        if (changed >> i & 1) matrix[i / 4][i % 4] = bytes.take<Scalar>();
    return matrix;
}

Imath::Box2i take_box(Bytes &bytes) {
    const auto corners = bytes.take<std::array<int, 4>>();
    return {{corners[0], corners[1]}, {corners[2], corners[3]}};
}

void put_attribute(Imf::Header &header, Bytes &bytes) {
    static constexpr std::array names{"pinholeFocalLength",
                                      "sparselens:sensorWidth",
                                      "sparselens:metresPerUnit",
                                      "sparselens:lensPoints",
                                      "sparselens:dataWindow",
                                      "aperture",
                                      "focus",
                                      "worldToCamera",
                                      "worldToNDC"};
    const auto kind = bytes.take<std::uint8_t>();
    const char *name = names[kind % names.size()];
    switch (kind / 16 % 7) {
    case 0: header.insert(name, Imf::FloatAttribute(bytes.take<float>())); break;
    case 1: header.insert(name, Imf::DoubleAttribute(bytes.take<double>())); break;
    case 2: header.insert(name, Imf::StringAttribute(bytes.text(kind))); break;
    case 3: header.insert(name, Imf::M44fAttribute(take_matrix<float>(bytes))); break;
    case 4: header.insert(name, Imf::M44dAttribute(take_matrix<double>(bytes))); break;
    case 5: header.insert(name, Imf::Box2iAttribute(take_box(bytes))); break;
    default: break;
    }
}

Camera take_camera(Bytes &bytes, Imf::Header &header) {
    for (int i = bytes.take<std::uint8_t>() % 12; i > 0; --i)
        fuzz::may_fail([&] { put_attribute(header, bytes); });
    return read_camera(header);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes bytes(data, size);
    Imf::Header header(64, 48);
    const Camera centre = take_camera(bytes, header);
    Imf::Header rim_header(64, 48);
    const Camera rim = take_camera(bytes, rim_header);
    const Windows windows = windows_of_size(64, 48);
    read_picture_window(header);
    fuzz::may_fail([&] { resolve_lens(centre, windows); });
    fuzz::may_fail([&] {
        const std::array<std::string, 1> names{"rim"};
        position_on_lens({&rim, 1}, names, centre);
    });
    fuzz::may_fail([&] { moved_across_lens(centre, {1, 2}); });
    write_camera(header, centre);
    const Camera again = read_camera(header);
    if (again.lens_points.size() != centre.lens_points.size()) __builtin_trap();
    return 0;
}
