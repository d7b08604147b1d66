// Any bytes as a plan: read, and the pixels of its views marked.
#include "io/plan_file.h"

#include "base/grid.h"
#include "fuzz/fuzz.h"
#include "io/files/text_file.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const MemoryFile file(fuzz::text_of(data, size));
    fuzz::may_fail([&] {
        for (const RequestedView &view : read_plan(file.path()).views)
            if (Grid(view.window).size() < 1 << 16) fuzz::may_fail([&] { mask_of(view).count(); });
    });
    return 0;
}
