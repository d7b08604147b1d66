#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_header.h"
#include "support/scratch_folder.h"

#include <ImfCompression.h>
#include <ImfStringAttribute.h>
#include <OpenEXRConfig.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

namespace sparselens {
namespace {

std::string word(std::uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += char(value >> shift & 0xff);
    return bytes;
}
std::string text(const std::string &name) { return name + '\0'; }
std::string attribute(const std::string &name, const std::string &type, const std::string &value) {
    return text(name) + text(type) + word(std::uint32_t(value.size())) + value;
}
const std::string one_part = word(20000630) + word(2), parts = word(20000630) + word(2 | 0x1000);

class HeaderCheck : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("x.exr");

    std::string said(const std::string &bytes) {
        put_contents(path, bytes);
        try {
            const auto in = open_input(path);
            check_header(*in, path);
            EXPECT_EQ(in->tellg(), 0u);
            return {};
        } catch (const Error &error) {
            const std::string what = error.what();
            EXPECT_TRUE(what.starts_with(path + ": ")) << what;
            return what.substr(path.size() + 2);
        }
    }
};

TEST_F(HeaderCheck, ANewerCompressionSaysWhatToDo) {
    const auto by = [&](int code) {
        return said(one_part + attribute("compression", "compression", std::string(1, char(code))) + '\0');
    };
    EXPECT_EQ(by(Imf::DWAB_COMPRESSION), "");
    const std::array names{"HTJ2K256, 3.4", "HTJ2K32, 3.4", "LJ2K, 3.5", "ZSTD, 3.5", "code 14"};
    for (int code = 10; code <= 255; code = code < 14 ? code + 1 : code + 241)
        EXPECT_EQ(by(code), code < int(Imf::NUM_COMPRESSION_METHODS)
                                ? ""
                                : fmt::format("compressed by a newer OpenEXR than {} ({}): where that is, "
                                              "oiiotool IN --compression zips -o OUT.exr",
                                              OPENEXR_VERSION_STRING,
                                              code <= 14 ? names[std::size_t(code - 10)] : "code 255"));
}

TEST_F(HeaderCheck, SoundHeadersPass) {
    Imf::Header header;
    header.insert("comments", Imf::StringAttribute("a comment"));
    write_flat_exr(path, Image(windows_of_size(3, 2), rgba_channels()), header);
    EXPECT_EQ(said(contents_of(path)), "");
    EXPECT_EQ(said(one_part + attribute("any", "thing", "value") + '\0'), "");
    EXPECT_EQ(said(parts + attribute("a", "b", "c") + '\0' + attribute("d", "e", "") + '\0' + '\0'), "");
}

TEST_F(HeaderCheck, WhatIsNoExrIsNamed) {
    EXPECT_EQ(said(""), ""); // OpenEXR reports it
    EXPECT_TRUE(said("no picture at all").starts_with("not an EXR file; a photograph"));
    EXPECT_TRUE(said("\x93NUMPY\1 and more").starts_with("is a NumPy array: save it as a 16-bit PNG"));
    const std::string what_to_do =
        " picture, and EXR is needed: render to EXR, with depth, or convert what needs no "
        "depth (oiiotool IN -o OUT.exr)";
    EXPECT_EQ(said("\x89PNG\r\n\x1a\n and more"), "is a PNG" + what_to_do);
    EXPECT_EQ(said("\xff\xd8\xff\xe0 and more"), "is a JPEG" + what_to_do);
    EXPECT_EQ(said(std::string("II*\0", 4) + "and more"), "is a TIFF" + what_to_do);
    EXPECT_EQ(said("#?RADIANCE and more"), "is a Radiance" + what_to_do);
    EXPECT_EQ(said("SDPX and more"), "is a DPX" + what_to_do);
}

TEST_F(HeaderCheck, AttributesLargerThanTheFile) {
    EXPECT_EQ(said(one_part + text("any") + text("thing") + word(0x7fffffff) + "value"),
              "attribute any claims 2147483647 bytes, more than the file has");
    EXPECT_EQ(said(one_part + text("any") + text("thing") + word(0xffffffff)),
              "attribute any claims 4294967295 bytes, more than the file has");
}

TEST_F(HeaderCheck, AttributesOfAnotherSizeThanTheirTypes) {
    for (const char *type : {"box2i", "float", "m44f", "tiledesc"})
        EXPECT_EQ(said(one_part + attribute("any", type, "123") + '\0'),
                  "attribute any does not have the size of its type");
    const std::string claims = "attribute any does not have the size that it claims";
    const std::string channel = text("R") + std::string(16, '\1');
    EXPECT_EQ(said(one_part + attribute("any", "chlist", channel + '\0') + '\0'), "");
    EXPECT_EQ(said(one_part + attribute("any", "chlist", channel) + '\0' + '\0'), claims);
    EXPECT_EQ(said(one_part + attribute("any", "preview", word(1) + word(2) + std::string(8, 'x')) + '\0'),
              "");
    EXPECT_EQ(said(one_part + attribute("any", "preview", word(0x10000) + word(0x10000)) + '\0'), claims);
    EXPECT_EQ(said(one_part + attribute("any", "stringvector", word(2) + "ab" + word(0)) + '\0'), "");
    EXPECT_EQ(said(one_part + attribute("any", "stringvector", word(0x7fffffff) + "ab") + '\0'), claims);
}

TEST_F(HeaderCheck, HeadersThatDoNotEnd) {
    EXPECT_EQ(said(one_part), "the file is truncated");
    EXPECT_EQ(said(one_part + attribute("any", "thing", "value")), "the file is truncated");
    EXPECT_EQ(said(one_part + std::string(300, 'x') + '\0'), "a name in the header does not end");
}

} // namespace
} // namespace sparselens
