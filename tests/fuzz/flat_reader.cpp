// Any bytes as a rendered view: header, pixels and depth are read and sanitized.
#include "deep/sanitize.h"
#include "deep/view_samples.h"
#include "fuzz/fuzz.h"
#include "io/exr/exr_flat.h"
#include "io/files/memory_limit.h"
#include "io/files/text_file.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    set_memory_limit(std::uint64_t(4) << 20); // small pictures find the same faults sooner
    const MemoryFile file(fuzz::text_of(data, size));
    fuzz::may_fail([&] { read_flat_header(file.path()); });
    fuzz::may_fail([&] {
        FlatFile flat = read_flat_exr(file.path());
        View view{"fuzz", std::move(flat.image), {}};
        view.z = take_depth(view.image, {}, "fuzz");
        sanitize(view);
        ViewSamples(view, view.image.channels).as_ldi();
    });
    return 0;
}
