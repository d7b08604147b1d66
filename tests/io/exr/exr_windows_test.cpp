// Flat parts of one picture with different data windows: cropped elements, depth over the whole picture.
#include "base/error.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/open_view.h"
#include "support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

// The columns [first, last] of a picture of one row; every value is `value`.
struct FlatPart {
    std::string name;
    std::vector<std::string> channels;
    int first, last;
    float value;
};

class ExrWindows : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("parts.exr");

    void write(const std::vector<FlatPart> &parts) {
        std::vector<Imf::Header> headers;
        for (const FlatPart &part : parts) {
            Imf::Header header(Imath::Box2i({0, 0}, {5, 0}), Imath::Box2i({part.first, 0}, {part.last, 0}));
            header.setName(part.name);
            header.setType(Imf::SCANLINEIMAGE);
            for (const std::string &channel : part.channels)
                header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
            headers.push_back(header);
        }
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
        for (std::size_t i = 0; i < parts.size(); ++i) {
            std::vector<float> row(std::size_t(parts[i].last - parts[i].first + 1), parts[i].value);
            Imf::FrameBuffer pixels;
            for (const std::string &channel : parts[i].channels)
                pixels.insert(channel, Imf::Slice::Make(Imf::FLOAT, row.data(), headers[i].dataWindow()));
            Imf::OutputPart part(file, int(i));
            part.setFrameBuffer(pixels);
            part.writePixels(1);
        }
    }
    static std::vector<float> values(const Image &image, const char *channel) {
        const auto plane = image.plane(find_channel(image.channels, channel));
        return {plane.begin(), plane.end()};
    }
};

TEST_F(ExrWindows, AreUnited) {
    write({{"rgba", {"R", "G", "B", "A"}, 1, 2, 1}, {"depth", {"Z"}, 2, 3, 4}, {"N", {"N.x"}, 0, 0, 7}});
    const FlatFile file = read_flat_exr(path);
    EXPECT_EQ(file.image.windows.data, Imath::Box2i({0, 0}, {3, 0}));
    EXPECT_EQ(file.header.dataWindow(), file.image.windows.data);
    EXPECT_EQ(read_flat_header(path).dataWindow(), file.image.windows.data);
    EXPECT_EQ(values(file.image, "R"), (std::vector<float>{0, 1, 1, 0}));
    EXPECT_EQ(values(file.image, "A"), (std::vector<float>{0, 1, 1, 0}));
    EXPECT_EQ(values(file.image, "N.x"), (std::vector<float>{7, 0, 0, 0}));
    EXPECT_EQ(open_view(path).view.z, (std::vector<float>{inf, inf, 4, inf}));
    EXPECT_EQ(read_ldi(path).ldi.windows.data, file.image.windows.data);
    EXPECT_EQ(file.warnings, (std::vector<std::string>{
                                 "depth Z covers 2x1 pixels at 2,0, but the colours cover 2x1 pixels at 1,0: "
                                 "colours without a depth count as infinitely far"}));
    write({{"rgba", {"R", "G", "B", "A"}, 1, 2, 1}, {"depth", {"Z"}, 0, 2, 4}});
    EXPECT_TRUE(read_flat_exr(path).warnings.empty());
}

TEST_F(ExrWindows, ThePartMayTellThatAChannelIsDepth) {
    for (const std::string part : {"depth", "Z", "ZDepth"}) {
        write({{"rgba", {"R", "G", "B", "A"}, 0, 3, 1}, {part, {"Y"}, 0, 3, 4}});
        EXPECT_EQ(open_view(path).view.z, (std::vector<float>{4, 4, 4, 4})) << part;
    }
    write({{"rgba", {"R", "G", "B", "A"}, 0, 3, 1}, {"far", {"Y"}, 0, 3, 4}});
    EXPECT_THROW(open_view(path), Error);
    EXPECT_EQ(open_view(path, {.depth = {.picture = {.depth = "far.Y"}}}).view.z,
              (std::vector<float>{4, 4, 4, 4}));
}

TEST_F(ExrWindows, ColoursWithoutCoverageCoverTheirOwnWindow) {
    write({{"rgb", {"R", "G", "B"}, 1, 2, 0.5f}, {"depth", {"Z"}, 0, 3, 4}});
    EXPECT_EQ(values(read_flat_exr(path).image, "A"), (std::vector<float>{0, 1, 1, 0}));
    write({{"rgb", {"R", "G", "B"}, 0, 3, 0.5f}, {"depth", {"Z"}, 1, 2, 4}});
    EXPECT_EQ(find_channel(read_flat_exr(path).image.channels, "A"), npos);
    EXPECT_EQ(open_view(path).view.z, (std::vector<float>{inf, 4, 4, inf}));
}

TEST_F(ExrWindows, WhatIsNotUsedIsNamed) {
    write({{"rgba", {"R", "N.x"}, 0, 3, 1}, {"N", {"N.N.x", "N.x"}, 0, 3, 2}});
    EXPECT_EQ(read_flat_exr(path).warnings,
              (std::vector<std::string>{"channel N.x of part N is not used: there is one of that name"}));
}

} // namespace
} // namespace sparselens
