#include "io/own_depth.h"
#include "support/scratch_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {
namespace {

using namespace std::string_literals;

// The depth in the files: own_depth_of_jpeg() only looks at its first bytes.
const std::string picture = "\x89PNG and all bytes \0\xff\xd9\xff"s;

std::string number(std::size_t value, int bytes) {
    std::string text;
    for (int i = bytes; i-- > 0;) text += char(value >> 8 * i);
    return text;
}
std::string segment(std::string_view name, const std::string &data) {
    const std::string all = std::string(name) + '\0' + data;
    return "\xff\xe1" + number(all.size() + 2, 2) + all;
}
// A JPEG whose pixels have what looks like markers, and fill bytes before its last one.
std::string jpeg(const std::string &segments) {
    return "\xff\xd8\xff\xe0" + number(4, 2) + "\xff\xd9" + segments + "\xff\xda" + number(4, 2) + "ab" +
           "pixels \xff\0 \xff\xd3 more\xff\xff\xd9"s;
}
std::string rdf(const std::string &inside) {
    return "<?xpacket begin='>'?><x:xmpmeta xmlns:x='adobe:ns:meta/'><!-- <a b=> -->\n"
           "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">" +
           inside + "</rdf:RDF></x:xmpmeta>";
}
std::string xmp(const std::string &inside) { return segment("http://ns.adobe.com/xap/1.0/", rdf(inside)); }

std::string base64(std::string_view bytes, bool fill = true) {
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 6) {
        std::size_t value = 0;
        for (std::size_t b = bit; b < bit + 6; ++b)
            value = value << 1 |
                    (b < 8 * bytes.size() ? std::size_t(std::uint8_t(bytes[b / 8]) >> (7 - b % 8) & 1) : 0);
        text += digits[value];
    }
    while (fill && text.size() % 4 != 0) text += '=';
    return text;
}

const std::string gdepth = "http://ns.google.com/photos/1.0/depthmap/", format = " g:Format='RangeInverse'",
                  data = " g:Data='" + base64(picture) + "'";
std::string described(const std::string &attributes, const std::string &inside = "") {
    return "<rdf:Description xmlns:g=\"" + gdepth + "\"" + attributes + ">" + inside + "</rdf:Description>";
}

const std::string name = "0123456789ABCDEF0123456789ABCDEF",
                  noted = " xmlns:n='http://ns.adobe.com/xmp/note/' n:HasExtendedXMP='" + name + "'";
std::string piece(const std::string &of, std::size_t begin, std::size_t end, const std::string &by = name) {
    return segment("http://ns.adobe.com/xmp/extension/",
                   by + number(of.size(), 4) + number(begin, 4) + of.substr(begin, end - begin));
}
const std::string extended = rdf(described(data)), first = xmp(described(format + noted)),
                  head = piece(extended, 0, 90), tail = piece(extended, 90, extended.size());

std::string item(const std::string &words) {
    return "<rdf:li rdf:parseType='Resource'><c:Item " + words + "/></rdf:li>";
}
// A directory of the primary picture, 5 bytes of padding, another item, and the depth.
std::string
dynamic(const std::string &of_depth,
        const std::string &words = " d:Format='RangeLinear' d:Near='0.5' d:Far='8' d:DepthURI='a/depth'") {
    return xmp("<rdf:Description xmlns:c='http://ns.google.com/photos/dd/1.0/container' "
               "xmlns:i='http://ns.google.com/photos/dd/1.0/item/' "
               "xmlns:d='http://ns.google.com/photos/dd/1.0/depthmap/'" +
               words + "><dc:creator><rdf:li>me</rdf:li></dc:creator><c:Directory><rdf:Seq>" +
               item("i:Mime='image/jpeg' i:Length='0' i:Padding='5' i:DataURI='a/primary'") +
               item("i:Semantic='GainMap' i:Length='3'") + item(of_depth) +
               "</rdf:Seq></c:Directory></rdf:Description>");
}
const std::string length = fmt::format(" i:Length='{}'", picture.size());

TEST(OwnDepth, IsFoundInEitherSyntaxOfXmpAndInItsExtension) {
    const std::string elements = described("", "<g:Format>RangeInverse</g:Format>\n<g:Data>\n " +
                                                   base64(picture, false).insert(8, "\n ") + "</g:Data>");
    for (const std::string &inside :
         {xmp(described(format + data)), xmp(elements),
          xmp(described(format, "<g:Data>" + base64(picture) + "</g:Data>")), first + head + tail,
          first + tail + piece("another", 0, 7, std::string(32, 'F')) + head}) {
        SCOPED_TRACE(inside);
        const auto found = own_depth_of_jpeg(jpeg(inside));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->picture, picture);
        EXPECT_EQ(found->values, OwnDepth::Values::inverse);
    }
}

TEST(OwnDepth, IsAnItemBehindThePicture) {
    for (const std::string &words :
         {"i:DataURI='a/depth'" + length, "i:Semantic='Depth'" + length, "i:Semantic='DepthMap'" + length}) {
        const auto found = own_depth_of_jpeg(jpeg(dynamic(words)) + "12345" + "abc" + picture + "trailer");
        ASSERT_TRUE(found) << words;
        EXPECT_EQ(found->picture, picture);
        EXPECT_EQ(found->values, OwnDepth::Values::linear);
        EXPECT_EQ(found->near, 0.5);
        EXPECT_EQ(found->far, 8);
    }
    EXPECT_FALSE(
        own_depth_of_jpeg(jpeg(dynamic("i:Semantic='MotionPhoto'" + length, "")) + "12345abc" + picture));
}

TEST(OwnDepth, OfApplesIsAJpegThatSaysSo) {
    const auto said = [](const std::string &type) {
        return xmp("<rdf:Description xmlns:p='http://ns.apple.com/pixeldatainfo/1.0/' p:FloatMinValue='0.25' "
                   "p:FloatMaxValue='4'>"
                   "<p:AuxiliaryImageType>" +
                   type + "</p:AuxiliaryImageType></rdf:Description>");
    };
    const std::string matte = jpeg(said("portraiteffectsmatte"));
    for (const char *type : {"disparity", "depth"}) {
        const std::string depth = jpeg(said(type));
        const auto found = own_depth_of_jpeg(jpeg("") + std::string(7, '\0') + matte + depth + matte);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->picture, depth);
        EXPECT_EQ(found->values, type == "depth"s ? OwnDepth::Values::linear : OwnDepth::Values::disparity);
        EXPECT_EQ(found->near, 0.25);
    }
    EXPECT_FALSE(own_depth_of_jpeg(jpeg("") + matte));
}

TEST(OwnDepth, IsNoneInOtherJpegs) {
    for (const std::string &file :
         {jpeg(""), jpeg(xmp("<rdf:Description a:b='c'/>")), std::string("\xff\xd8"), jpeg("").substr(0, 20)})
        EXPECT_FALSE(own_depth_of_jpeg(file));
}

TEST(OwnDepth, SaysWhyItCannotBeUsed) {
    const auto why = [](const std::string &file) {
        return what_of<std::runtime_error>([&] { own_depth_of_jpeg(file); });
    };
    const std::string behind = "12345abc" + picture, uri = "i:DataURI='a/depth'";
    EXPECT_EQ(why(jpeg(xmp(described(format + " g:Data='iVB*'")))), "the base64 is damaged");
    EXPECT_EQ(why(jpeg(xmp(described(format + " g:Data='iV=B'")))), "the base64 is damaged");
    EXPECT_EQ(why(jpeg(xmp(described(format + " g:Data='iVBOR'")))), "the base64 is cut off");
    EXPECT_EQ(why(jpeg(xmp(described(format + " g:Data='iVBO")))), "the XMP is damaged");
    EXPECT_EQ(why(jpeg(xmp(described(format + " g:Data")))),
              "the XMP describes it, but the file does not have it");
    for (const std::string &pieces :
         {std::string(), head, tail, head + piece(extended, 91, extended.size()),
          piece(extended, 0, 90, std::string(32, 'F')) + tail, head + piece(extended + "more", 90, 200)})
        EXPECT_EQ(why(jpeg(first + pieces)), "a part of the XMP is missing");
    EXPECT_EQ(why(jpeg(xmp(described(format)))), "the XMP describes it, but the file does not have it");
    EXPECT_EQ(why(jpeg(xmp(described(data)))), "the Format is neither RangeInverse nor RangeLinear");
    EXPECT_EQ(why(jpeg(xmp(described(format + " g:Data='" + base64("text") + "'")))),
              "it is neither a PNG nor a JPEG");
    for (const char *words : {" g:Near='1'", " g:Near='0' g:Far='3'", " g:Near='2' g:Far='1'",
                              " g:Near='1' g:Far='inf'", " g:Near='nan' g:Far='2'"})
        EXPECT_EQ(why(jpeg(xmp(described(" g:Format='RangeLinear'"s + words + data)))),
                  "Near and Far are not depths");
    for (const char *words : {"", " i:Length='0'", " i:Length='24'", " i:Length='-3'",
                              " i:Length='99999999999999999999'", " i:Length='18446744073709551615'"})
        EXPECT_EQ(why(jpeg(dynamic(uri + words)) + behind), "it is not where the XMP says") << words;
    EXPECT_EQ(why(jpeg(dynamic(uri + length)) + behind.substr(0, 20)), "it is not where the XMP says");
    EXPECT_EQ(why(jpeg(dynamic(uri + length)).substr(0, jpeg(dynamic(uri + length)).size() - 3)),
              "it is not where the XMP says"); // no end of its pixels
    EXPECT_EQ(why(jpeg(dynamic(uri + length)) + "1234" + picture + "12345"),
              "it is neither a PNG nor a JPEG");
}

// Wherever a file is cut off, it has no depth, another one, or one that cannot be used.
TEST(OwnDepth, MayBeCutOffAnywhere) {
    const std::string appended = xmp("<rdf:Description xmlns:p='http://ns.apple.com/pixeldatainfo/1.0/' "
                                     "p:AuxiliaryImageType='disparity'/>");
    for (const std::string &file :
         {jpeg(first + head + tail), jpeg(dynamic("i:Semantic='Depth'" + length)) + "12345abc" + picture,
          jpeg("") + jpeg(appended)})
        for (std::size_t size = 2; size < file.size(); ++size) {
            const std::string why =
                what_of<std::runtime_error>([&] { own_depth_of_jpeg(file.substr(0, size)); });
            EXPECT_FALSE(why.empty());
        }
}

// The values are those of the formulas of the format.
TEST(OwnDepth, BecomesADisparity) {
    constexpr double near = 0.5, far = 8;
    for (const double z : {0.5, 0.7, 2.0, 8.0}) {
        std::array linear{float((z - near) / (far - near))},
            inverse{float(far * (z - near) / (z * (far - near)))};
        const double wanted = (1 / z - 1 / far) / (1 / near - 1 / far);
        make_disparities({"", OwnDepth::Values::linear, near, far}, linear);
        make_disparities({"", OwnDepth::Values::inverse}, inverse);
        EXPECT_NEAR(linear[0], wanted, 1e-5);
        EXPECT_NEAR(inverse[0], wanted, 1e-6);
    }
    std::array stays{0.3f};
    make_disparities({"", OwnDepth::Values::disparity}, stays);
    EXPECT_EQ(stays[0], 0.3f);
}

} // namespace
} // namespace sparselens
