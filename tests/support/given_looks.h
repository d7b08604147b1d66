// Values of looks for tests: given(std::pair(&LookValues::blades, 5), ...).
#pragma once

#include "looks/table.h"

#include <utility>

namespace sparselens {

template <typename... Value, typename... Number>
LookValues given(std::pair<Value, Number>... values) {
    LookValues all;
    ((all.*values.first = values.second), ...);
    return all;
}

} // namespace sparselens
