// The devices of the keyword device, which the calls of a process share until the interpreter ends.
#pragma once

#include "chain/devices.h"

namespace sparselens::python {

inline GatherDevice &gather_device() {
    static GatherDevice one;
    return one;
}
inline WarpingDevice &warp_device() {
    static WarpingDevice one;
    return one;
}

} // namespace sparselens::python
