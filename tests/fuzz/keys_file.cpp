// Any bytes as a file of keys of each kind: read, and evaluated at some frames. The values must read as the same kind.
#include "fuzz/fuzz.h"
#include "harness/commands/keys.h"
#include "io/files/text_file.h"

#include <fmt/format.h>

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const MemoryFile file(fuzz::text_of(data, size));
    for (const KeyKind kind : {KeyKind::number, KeyKind::pixel, KeyKind::pair})
        fuzz::may_fail([&] {
            const Keys keys = read_keys(file.path(), kind);
            for (const int frame : {-2'000'000'000, 0, 2, 2'000'000'000}) {
                const std::string word = word_at_frame(keys, frame);
                if (word.find("nan") == std::string::npos && word.find("inf") == std::string::npos &&
                    !parse_keys(fmt::format("0:{}", word), kind))
                    __builtin_trap();
            }
        });
    return 0;
}
