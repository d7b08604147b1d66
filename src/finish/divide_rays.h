// Divides a budget of rays between views, which are gathered, and two renders through the lens, which finish the picture.
//
// The first rays go into the views, because a gathered picture of few rays has less error than as many rays through the
// lens. Its error soon stops falling. The error of rays does not, so all further rays go through the lens. Where the
// noise of all rays through the lens is small, views add nothing to one render of them.
#pragma once

namespace sparselens {

// Counts rays for each pixel of the picture.
struct RayDivision {
    int views = 1;       // number of views, the centre view included
    int supersample = 1; // times the size of the picture at which views are rendered
    int samples = 1;     // samples of each pixel of a view
    int per_render = 0;  // rays of each of the two renders through the lens; 0: views alone
    double noise = 0;    // of one render of all rays through the lens: mean square, tone-mapped
    bool alone = false;  // such a render has less error than the rest of this division

    int of_views() const { return views * samples * supersample * supersample; }
};

// `rays`: all rays of a pixel. `views`: how many are worth it. `supersample`: the size at which they are worth it; with
// fewer rays than pixels, they are rendered at the size of the picture. `noise`: as in RayDivision. The division has at
// most `rays` rays. Throws UsageError if `rays` are fewer than `views`.
RayDivision divide_rays(int rays, int views, int supersample, double noise);

} // namespace sparselens
