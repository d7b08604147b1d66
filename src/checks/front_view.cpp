#include "checks/front_view.h"

namespace sparselens {

View front_view(const Ldi &ldi, const std::string &name) {
    std::vector<std::size_t> from; // channels
    std::vector<Channel> channels;
    for (const std::size_t k : find_rgb(ldi.channels))
        if (k != npos) {
            from.push_back(k);
            channels.push_back(ldi.channels[k]);
        }
    View view{name, Image(ldi.windows, channels), std::vector<float>(ldi.windows.pixels())};
    for (std::size_t pixel = 0; pixel < view.z.size(); ++pixel) {
        const std::uint64_t front = ldi.begin[pixel];
        if (front == ldi.begin[pixel + 1]) continue;
        view.z[pixel] = ldi.z[front];
        for (std::size_t k = 0; k < from.size(); ++k) view.image.plane(k)[pixel] = ldi.values[from[k]][front];
    }
    return view;
}

} // namespace sparselens
