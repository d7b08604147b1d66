#include "deep/front_samples.h"

namespace sparselens {

float front_depth(const Ldi &ldi, const Imath::V2i &pixel) {
    if (!ldi.windows.data.intersects(pixel)) return 0;
    const std::size_t i = ldi.windows.index(pixel.x, pixel.y);
    return ldi.pixel(i).empty() ? 0 : ldi.z[ldi.pixel(i).front()];
}

Image front_depth(const Ldi &ldi) {
    Image depth(ldi.windows, {{"Z", PixelType::float32, ChannelKind::data}});
    for (std::size_t i = 0; i < ldi.windows.pixels(); ++i)
        depth.values[i] = ldi.pixel(i).empty() ? depth_of_nothing : ldi.z[ldi.pixel(i).front()];
    return depth;
}

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

std::vector<float> front_circles_of_confusion(const Ldi &ldi, const ThinLens &lens) {
    std::vector<float> c(ldi.windows.pixels());
    for (std::size_t i = 0; i < c.size(); ++i) {
        const SampleRange samples = ldi.pixel(i);
        c[i] = float(circle_of_confusion(lens, samples.empty() ? std::numeric_limits<double>::infinity()
                                                               : ldi.optical_z(samples.front())));
    }
    return c;
}

} // namespace sparselens
