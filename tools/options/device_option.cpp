#include "options/device_option.h"

#include "gpu/device_list.h"

#include <CLI/CLI.hpp>

namespace sparselens {

void add_device_option(CLI::App &app, std::string &device, const std::string &what_works) {
    const auto list = [](const std::string &word) {
        if (word != "list") return;
        std::string lines;
        for (const gpu::DeviceInfo &there : gpu::list_devices()) lines += "\n" + gpu::description(there);
        throw CLI::CallForVersion(lines.empty() ? gpu::no_devices : lines.substr(1), 0);
    };
    app.add_option("--device", device,
                   what_works +
                       ": the CPU, a GPU if there is one, a GPU, or the device whose name has that "
                       "in it, also one in software. list prints those that there are (default: cpu)")
        ->type_name("cpu|auto|gpu|list")
        ->group("Device")
        ->envname("SPARSELENS_DEVICE")
        ->each(list);
}

} // namespace sparselens
