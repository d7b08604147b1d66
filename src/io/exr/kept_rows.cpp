#include "io/exr/kept_rows.h"

#include "base/parallel.h"

#include <utility>
#include <vector>

namespace sparselens {

namespace {

// Reserves room for as many samples as the file has; it takes no memory before it is used.
void append_rows(Ldi &ldi, Ldi rows, std::uint64_t most) {
    ldi.channels = rows.channels;
    ldi.values.resize(rows.values.size());
    const std::uint64_t before = ldi.begin.back();
    for (std::size_t pixel = 0; pixel + 1 < rows.begin.size(); ++pixel)
        ldi.begin.push_back(before + rows.begin[pixel + 1]);
    const std::vector<std::vector<float> *> to = arrays_of(ldi), from = arrays_of(rows);
    parallel_for(to.size(), [&](std::size_t k) {
        if (!from[k]->empty()) to[k]->reserve(most);
        to[k]->insert(to[k]->end(), from[k]->begin(), from[k]->end());
    });
}

} // namespace

KeptRows::KeptRows(Ldi &ldi, std::uint64_t most, std::optional<PackedRows> &packed)
    : ldi_(ldi), most_(most), packed_(packed) {
    ldi.begin.assign(1, 0);
    ldi.begin.reserve(ldi.windows.pixels() + 1);
}

void KeptRows::add(Ldi rows) {
    if (packed_) return packed_->append(rows);
    append_rows(ldi_, std::move(rows), most_);
    if (takes_much()) pack();
}

bool KeptRows::takes_much() const {
    return bytes_to_gather(ldi_.samples(), ldi_.channels) > memory_to_gather(most_, ldi_.windows.pixels());
}

void KeptRows::pack() {
    packed_.emplace(ldi_.windows);
    packed_->append(ldi_);
    drop();
}

void KeptRows::drop() {
    for (std::vector<float> *array : arrays_of(ldi_)) std::vector<float>().swap(*array);
    ldi_.begin.assign(ldi_.windows.pixels() + 1, 0);
}

} // namespace sparselens
