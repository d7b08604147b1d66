// The devices of the keyword device: looked for when a call first asks for one, and kept for the next ones until the
// interpreter ends. One gather at a time has its device, and one warp; others wait for it.
#pragma once

#include "dof/device/tile_device.h"
#include "warp/warp_device.h"

#include <functional>
#include <string>
#include <vector>

namespace sparselens::python {

// Calls work(device) with what `word` means, as choose_device() of gpu/device_list.h has it; null: the CPU. Appends to
// `warnings` what went wrong with the device, where the CPU then did the work. The interpreter's lock is not needed.
void with_gather_device(const std::string &word, std::vector<std::string> &warnings,
                        const std::function<void(TileDevice *)> &work);
void with_warp_device(const std::string &word, std::vector<std::string> &warnings,
                      const std::function<void(WarpDevice *)> &work);

// Gives the devices back.
void release_devices();

} // namespace sparselens::python
