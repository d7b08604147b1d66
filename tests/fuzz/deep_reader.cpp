// Any bytes as an LDI: read, sanitized, tidied, clustered, flattened.
#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/sanitize.h"
#include "deep/tidy.h"
#include "fuzz/fuzz.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_deep.h"
#include "io/files/memory_limit.h"
#include "io/files/text_file.h"

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    set_memory_limit(std::uint64_t(4) << 20); // small pictures find the same faults sooner
    const MemoryFile file(fuzz::text_of(data, size));
    fuzz::may_fail([&] {
        LdiFile in = read_ldi(file.path());
        sanitize(in.ldi, "fuzz");
        const Ldi ldi = tidy(std::move(in.ldi));
        Progress silent;
        const Clustered fewer = cluster(ldi, {.scale = 100, .tolerance = 0.25, .layers = 3}, silent);
        flatten(fewer.ldi);
        front_depth(fewer.ldi);
        read_picture_window(in.header);
    });
    return 0;
}
