#include "lab/report/base64.h"
#include "lab/report/page.h"
#include "lab/report/plot.h"
#include "lab/report/summary.h"
#include "lab/tests/report/report_rows.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

bool holds(const std::string &text, const std::string &what) { return text.find(what) != std::string::npos; }

std::size_t count(const std::string &text, const std::string &what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

TEST(Base64, AgreesWithTheExamplesOfRfc4648) {
    const auto of = [](const std::string &text) { return base64(text); };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foob"), "Zm9vYg==");
    EXPECT_EQ(of("fooba"), "Zm9vYmE=");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(of("\xff\xfe\x80"), "//6A");
}

TEST(Page, HoldsAllOfItself) {
    std::vector<ReportRow> rows = ray_tracing_rows();
    rows.push_back(report_row(Role::sparse_lens, "<sparse> & \"co\"", 2, 5, 39));
    rows.back().errors.front().nonfinite_image = 12345;
    const std::string html = page_as_html({{"a < machine"},
                                           {{rows,
                                             {"1 < 2"},
                                             {"<svg/>"},
                                             {"<svg2/>"},
                                             {{"reference", "foo"}, {"best", "bar"}},
                                             {{"a > block", "foob"}}}}});
    EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
    EXPECT_TRUE(holds(html, "a &lt; machine"));
    EXPECT_TRUE(holds(html, "1 &lt; 2"));
    EXPECT_TRUE(holds(html, "&lt;sparse&gt; &amp; &quot;co&quot;"));
    EXPECT_TRUE(holds(html, "data:image/png;base64,Zm9v\""));
    EXPECT_TRUE(holds(html, "data:image/svg+xml;base64,PHN2Zy8+\""));
    EXPECT_TRUE(holds(html, "data:image/svg+xml;base64,PHN2ZzIvPg==\"")); // on demand
    EXPECT_TRUE(holds(html, "a &gt; block"));
    EXPECT_TRUE(holds(html, "data:image/png;base64,Zm9vYg==\""));
    EXPECT_TRUE(holds(html, ">12345</td>")); // the page reports non-finite values
    EXPECT_EQ(count(html, "<tr"), 1 + rows.size());
    EXPECT_TRUE(holds(html, "startViewer"));
    for (const char *from_elsewhere : {"http:", "https:", "src=\"/", "<link", "@import", "url("})
        EXPECT_FALSE(holds(html, from_elsewhere)) << from_elsewhere;
}

TEST(Page, RowsHaveAsManyCellsAsTitles) {
    const auto rows = ray_tracing_rows();
    const std::string html = page_as_html({{}, {{rows, {}, {}, {}, {}, {}}}});
    EXPECT_EQ(count(html, "</td>"), rows.size() * count(html, "</th>"));
}

TEST(Plot, HasALineAMethodAndNoPointAtInfinity) {
    std::vector<ReportRow> rows = ray_tracing_rows();
    rows.push_back(report_row(Role::sparse_lens, "say \"sparse\"", 2, 5, 40));
    rows.push_back(report_row(Role::other, "exact", 2, 5, std::numeric_limits<double>::infinity()));
    const std::string script = plot_script(rows, "fence");
    EXPECT_EQ(count(script, " << END\n"), 3u);
    EXPECT_TRUE(holds(script, "\n2 5 0.01\n")); // 40 dB
    EXPECT_FALSE(holds(script, "inf"));
    EXPECT_TRUE(holds(script, "title \"say \\\"sparse\\\", lens\""));
    for (const char *file : {"fence-seconds.svg", "fence-seconds.png", "fence-rays.svg", "fence-rays.png"})
        EXPECT_TRUE(holds(script, file)) << file;
    EXPECT_TRUE(holds(script, "set yrange [0.00562341:0.0562341]\nset y2range [45:25]")); // the same, twice
}

TEST(Summary, SaysWhatTheRowsGained) {
    std::vector<ReportRow> rows = ray_tracing_rows();
    rows.push_back(report_row(Role::sparse_lens, "sparse", 2, 5, 39));
    const std::string text = summary_text(rows);
    EXPECT_TRUE(holds(text, "passes it at 8 s, 32 rays a pixel"));
    EXPECT_EQ(summary_text({}), "");
}

} // namespace
} // namespace sparselens::lab
