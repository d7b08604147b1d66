// Keeps rows of a deep part that are read one after the other: as samples, or packed if they are many.
#pragma once

#include "deep/ldi.h"
#include "deep/packed_rows.h"

#include <cstdint>
#include <optional>

namespace sparselens {

class KeptRows {
public:
    // `most`: the number of samples in the file.
    KeptRows(Ldi &ldi, std::uint64_t most, std::optional<PackedRows> &packed);
    void add(Ldi rows);
    void drop(); // drops all rows of the LDI

private:
    bool takes_much() const;
    void pack();

    Ldi &ldi_;
    std::uint64_t most_;
    std::optional<PackedRows> &packed_;
};

} // namespace sparselens
