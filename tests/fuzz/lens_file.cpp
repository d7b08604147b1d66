// Any bytes as the JSON of a lens: read, and resolved for two f-numbers.
#include "io/lens_file.h"

#include "fuzz/fuzz.h"
#include "io/files/text_file.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const MemoryFile file(fuzz::text_of(data, size));
    fuzz::may_fail([&] { read_lens_file(file.path(), {}); });
    fuzz::may_fail([&] {
        const LensFile lens = read_lens_file(file.path(), 2.3);
        for (const LookNumber &number : look_numbers()) // read values are in their range
            if (const auto &value = lens.values.*number.value; value && !number.range.holds(*value))
                __builtin_trap();
    });
    return 0;
}
