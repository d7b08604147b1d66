#include "dof/gather_picture.h"

#include "deep/flatten.h"
#include "dof/defocused_holdout.h"

namespace sparselens {

Image gather_picture(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress) {
    if (options.holdout && options.holdout_defocused) {
        PictureOptions without = options;
        without.holdout = nullptr;
        return without_holdout(
            gather_picture(with_holdout(ldi, *options.holdout), lens, gathered, written, without, progress));
    }
    const auto sharp = options.holdout ? std::optional<Holdout>(*options.holdout) : std::nullopt;
    if (lens.radius == 0) return crop(sharp ? flatten_held_out(ldi, *sharp) : flatten(ldi), written);
    GatherOptions by = options.gather;
    by.lens.region = written;
    by.lens.holdout = sharp ? &*sharp : nullptr;
    return crop(options.method->gather(ldi, lens, gathered, by, progress), written);
}

} // namespace sparselens
