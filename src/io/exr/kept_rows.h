// Keeps rows of a deep part that are read one after the other: as samples, or packed if they are many.
#pragma once

#include "deep/ldi.h"
#include "deep/packed_rows.h"

#include <cstdint>
#include <optional>

namespace sparselens {

class KeptRows {
public:
    // `most`: samples of the file.
    KeptRows(Ldi &ldi, std::uint64_t most, std::optional<PackedRows> &packed);
    void add(Ldi rows);
    void drop(); // all of the LDI's

private:
    bool takes_much() const;
    void pack();

    Ldi &ldi_;
    std::uint64_t most_;
    std::optional<PackedRows> &packed_;
};

} // namespace sparselens
