// The pictures that match_lens() compares: a plate, and what an LDI shows through a lens, both reduced.
#pragma once

#include "chain/match_lens.h"
#include "dof/gather_picture.h"
#include "match/lens_search.h"

#include <string>

namespace sparselens {

// A shot to match: what does not depend on the size of the compared pictures.
struct Match {
    const OpenedLdi &in;
    const Image &plate;
    const std::string &plate_name;
    const MatchRequest &request;
    Camera camera;
    Imath::Box2i region; // pixels of the plate
    int across = 1;      // sub-pixels of the LDI to a pixel of the plate
};

// Both pictures, `by` times smaller than the plate. Throws UsageError if they share no pixel of the region.
class Reduced {
public:
    Reduced(const Match &match, int by, bool is_final);
    Reduced(const Reduced &) = delete; // `pictures` gathers from this
    Reduced &operator=(const Reduced &) = delete;

    Comparison pictures;

    int by() const { return by_; }
    double radius() const { return radius_; }
    double depth_scale() const; // R F, pixels times scene units

private:
    void choose_gathers(const Match &match, bool is_final);
    ThinLens lens(double focus, double scale) const; // `focus`: its perceptive depth
    void find_usable();
    void find_depths();
    Colours gather(double coc, double scale, bool exactly) const;

    std::string name_; // of the LDI, for messages
    int by_;
    Ldi ldi_;
    double radius_ = 0, focal_px_ = 0;
    PictureOptions quickly_, exactly_;
    Imath::Box2i box_; // the compared pixels
};

// The pixels of both; throws UsageError if there are none.
Imath::Box2i common_pixels(const Imath::Box2i &a, const Imath::Box2i &b);

} // namespace sparselens
