#include "harness/man_page.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace sparselens {
namespace {

// A small table with text that is hard to print.
struct Table {
    CLI::App app{"Does it", "do-it"};
    std::string in, out, how;
    int n = 0;

    Table() {
        app.add_option("in", in, ".exr or 'png'\nof any\\size")->type_name("IN.exr")->required();
        app.add_option("-o,--out-put", out, "Where to")->type_name("FILE")->required();
        app.add_option("--how", how, "Which way")->type_name("fast|well");
        app.add_option("-n", n, "How often")
            ->type_name("N")
            ->check(CLI::Range(0, 7))
            ->envname("TIMES")
            ->group("More");
    }
};

TEST(ManPage, HasWhatTheTableHas) {
    const Table table;
    const std::string page = man_page(table.app, "1.2");
    for (const char *line :
         {".TH DO-IT 1 \"\" \"sparselens 1.2\"", "do\\-it \\- Does it\n",
          "\\fBdo\\-it\\fR [\\fIoptions\\fR] \\fIIN.exr\\fR \\fB\\-o\\fR \\fIFILE\\fR\n",
          ".SH ARGUMENTS\n.TP\n\\fIIN.exr\\fR\n\\&.exr or 'png'\n.br", "of any\\esize\n",
          "\\fB\\-o\\fR, \\fB\\-\\-out\\-put\\fR \\fIFILE\\fR\nWhere to\n",
          "\\fB\\-\\-how\\fR \\fIfast|well\\fR\nWhich way\n",
          ".SS More\n.TP\n\\fB\\-n\\fR \\fIN\\fR\nHow often\n", "\\fBTIMES\\fR\nThe value of \\fB\\-n\\fR"})
        EXPECT_NE(page.find(line), std::string::npos) << line << "\nis not in\n" << page;
}

TEST(BashCompletion, HasOptionsAndTheirWords) {
    const Table table;
    const std::string text = bash_completion(table.app);
    for (const char *line : {"'-h --help -o --out-put --how -n'",
                             "--how) COMPREPLY=($(compgen -W 'fast well' ", "_do_it()", " -F _do_it do-it\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
    EXPECT_EQ(text.find("IN.exr"), std::string::npos) << text;
}

TEST(ZshCompletion, HasOptionsTheirWordsAndWhatTheyAreFor) {
    Table table;
    table.app.add_flag("--it")->description("Not [it's] so: no");
    const std::string text = zsh_completion(table.app);
    for (const char *line :
         {"#compdef do-it\n_arguments -s", "'*:IN.exr:_files'", "'*-o[Where to]:FILE:_files'",
          "'*--out-put[Where to]:FILE:_files'", "'*--how[Which way]:fast|well:(fast well)'",
          "'*--it[Not \\[it'\\''s\\] so\\: no]'"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
}

TEST(FishCompletion, HasOptionsTheirWordsAndWhatTheyAreFor) {
    Table table;
    table.app.add_flag("--it")->description("It's so");
    const std::string text = fish_completion(table.app);
    for (const char *line : {"complete -c do-it -s o -l out-put -r -d 'Where to'\n",
                             "complete -c do-it -l how -r -f -a 'fast well' -d 'Which way'\n",
                             "complete -c do-it -l it -d 'It'\\''s so'\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
    EXPECT_EQ(text.find("IN.exr"), std::string::npos) << text;
}

} // namespace
} // namespace sparselens
