#include "base/error.h"
#include "io/files/folder.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

TEST(MakeFolder, MakesWhatIsMissing) {
    const ScratchFolder scratch;
    const std::string folder = scratch.file("a/b/c");
    make_folder(folder);
    EXPECT_TRUE(std::filesystem::is_directory(folder));
    put_contents(folder + "/file", "text");
    make_folder(folder); // it exists: nothing happens
    EXPECT_EQ(contents_of(folder + "/file"), "text");
}

TEST(MakeFolder, NamesWhatItCannotMake) {
    const ScratchFolder scratch;
    const std::string file = scratch.file("file");
    put_contents(file, "text");
    for (const std::string &folder : {file, file + "/under"}) {
        const std::string what = what_of<Error>([&] { make_folder(folder); });
        EXPECT_TRUE(what.starts_with(folder + ": cannot create the folder: ")) << what;
    }
    EXPECT_EQ(contents_of(file), "text");
}

} // namespace
} // namespace sparselens
