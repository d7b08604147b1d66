// Reaches the lens, memory pictures and the threads through the installed headers and the static library.
#include <sparselens/base/image.h>
#include <sparselens/base/parallel.h>
#include <sparselens/lens/thin_lens.h>

#include <cstdio>

int main() {
    const sparselens::ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    sparselens::Image image(sparselens::windows_of_size(64, 1), sparselens::rgba_channels());
    sparselens::parallel_for(64, [&](std::size_t x) {
        image.at(0, int(x), 0) = float(sparselens::circle_of_confusion(lens, 10));
    });
    std::printf("%.2f\n", image.at(0, 63, 0));
}
