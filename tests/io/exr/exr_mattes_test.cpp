#include "base/error.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/open_view.h"
#include "support/mattes.h"
#include "support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

namespace sparselens {
namespace {

// A header that names its matte "things", which no naming rule recognises.
Imf::Header header_of_things() {
    Imf::Header header;
    header.insert("cryptomatte/ab12cd3/name", Imf::StringAttribute("things"));
    header.insert("cryptomatte/ab12cd3/hash", Imf::StringAttribute("MurmurHash3_32"));
    header.insert("cryptomatte/ab12cd3/conversion", Imf::StringAttribute("uint32_to_float32"));
    header.insert("cryptomatte/ab12cd3/manifest", Imf::StringAttribute("{\"a\":\"01234567\"}"));
    return header;
}

void expect_things(const Imf::Header &header) {
    EXPECT_EQ(matte_names(header), std::vector<std::string>{"things"});
    const auto *manifest = header.findTypedAttribute<Imf::StringAttribute>("cryptomatte/ab12cd3/manifest");
    ASSERT_NE(manifest, nullptr);
    EXPECT_EQ(manifest->value(), "{\"a\":\"01234567\"}");
}

Image picture_of_things() {
    Image image(windows_of_size(4, 1), {{"R"}, {"A"}, {"Z", PixelType::float32}});
    for (const char *name : {"things00.R", "things00.G", "things00.B", "things00.A"})
        image.channels.push_back({name, PixelType::float32});
    Image filled(image.windows, image.channels);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::vector<float> values{1, 1, 2, hashed(std::uint32_t(i)), 0.75f, hashed(9), 0.25f};
        for (std::size_t k = 0; k < values.size(); ++k) filled.plane(k)[i] = values[k];
    }
    return filled;
}

class ExrMattes : public testing::Test {
protected:
    ScratchFolder folder;
    std::string path = folder.file("picture.exr");
};

TEST_F(ExrMattes, AreFoundByTheHeaderAndKeptInFlatAndDeepFiles) {
    write_flat_exr(path, picture_of_things(), header_of_things());
    const FlatFile flat = read_flat_exr(path);
    EXPECT_EQ(ids_in(flat.image).size(), 5u);
    expect_things(flat.header);
    const LdiFile ldi = read_ldi(path);
    EXPECT_EQ(ids_in(ldi.ldi), ids_in(flat.image));
    write_ldi(path, ldi.ldi, ldi.header);
    const LdiFile again = read_ldi(path);
    EXPECT_EQ(ids_in(again.ldi), ids_in(flat.image));
    expect_things(again.header);
}

TEST_F(ExrMattes, HashesAreNotRepaired) {
    write_flat_exr(path, picture_of_things(), header_of_things());
    const OpenedView opened = open_view(path);
    EXPECT_FALSE(opened.bad.any());
    EXPECT_EQ(ids_in(opened.view.image), ids_in(read_flat_exr(path).image));
}

// A matte in its own part, named only by that part's header.
TEST_F(ExrMattes, OfAPartOfTheirOwn) {
    Imf::Header beauty(4, 1), things(4, 1);
    beauty.setName("rgba");
    things.setName("crypto");
    const Imf::Header named = header_of_things();
    for (auto it = named.begin(); it != named.end(); ++it)
        if (std::string(it.name()).starts_with("cryptomatte/")) things.insert(it.name(), it.attribute());
    beauty.channels().insert("R", Imf::Channel(Imf::FLOAT));
    things.channels().insert("things00.R", Imf::Channel(Imf::FLOAT));
    things.channels().insert("things00.G", Imf::Channel(Imf::FLOAT));
    std::vector<Imf::Header> headers{beauty, things};
    for (Imf::Header &header : headers) header.setType(Imf::SCANLINEIMAGE);
    std::vector<float> values{hashed(0), hashed(4), hashed(8), hashed(12)}, ones(4, 1);
    {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            Imf::FrameBuffer pixels;
            const auto &list = headers[std::size_t(part)].channels();
            for (auto it = list.begin(); it != list.end(); ++it)
                pixels.insert(it.name(), Imf::Slice(Imf::FLOAT,
                                                    reinterpret_cast<char *>(
                                                        std::string(it.name()) == "things00.R" ? values.data()
                                                                                               : ones.data()),
                                                    sizeof(float), 0));
            Imf::OutputPart output(file, part);
            output.setFrameBuffer(pixels);
            output.writePixels(1);
        }
    }
    const FlatFile read = read_flat_exr(path);
    EXPECT_EQ(ids_in(read.image).size(), 4u);
    expect_things(read.header);
}

TEST_F(ExrMattes, AreNotCompressedWithLoss) {
    Imf::Header header = header_of_things();
    header.compression() = Imf::DWAA_COMPRESSION;
    Image image = picture_of_things();
    find_kinds_by(header, image.channels);
    write_flat_exr(path, image, header);
    EXPECT_EQ(read_flat_header(path).compression(), Imf::ZIP_COMPRESSION);
    for (const auto lossy : {Imf::PXR24_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
        EXPECT_THROW(write_flat_exr(path, image, header, lossy), UsageError);
    for (const auto exact :
         {Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION}) {
        write_flat_exr(path, image, header, exact);
        EXPECT_EQ(ids_in(read_flat_exr(path).image), ids_in(image));
    }
}

} // namespace
} // namespace sparselens
