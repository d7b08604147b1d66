#include "chain/take_moments.h"

#include "base/error.h"
#include "chain/notices.h"
#include "io/moment_files.h"
#include "shutter/lamp_paths.h"
#include "shutter/shutter_mean.h"

#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

// Shows the progress of several moments as that of one picture.
class WholeProgress {
public:
    WholeProgress(Progress &whole, std::size_t moments) : whole_(whole) {
        whole_.start("gathering", moments * hundred);
    }

    // The progress of the next moment.
    Progress &next() {
        finish();
        reached_ = 0;
        part_.emplace([this](const std::string &, int percent) { reach(std::size_t(percent)); },
                      [this] { whole_.may_end(); });
        return *part_;
    }
    void finish() {
        if (!part_) return;
        reach(hundred);
        whole_.spent(part_->take_times());
    }

    // For work that shows no progress.
    Progress &unseen() {
        unseen_.emplace(Progress::Listener(), [this] { whole_.may_end(); });
        return *unseen_;
    }

private:
    static constexpr std::size_t hundred = 100;

    // A moment may begin a stage more than once.
    void reach(std::size_t percent) {
        const std::lock_guard lock(guard_);
        if (percent <= reached_) return;
        whole_.advance(percent - reached_);
        reached_ = percent;
    }

    Progress &whole_;
    std::optional<Progress> part_, unseen_;
    std::mutex guard_; // for reached_
    std::size_t reached_ = 0;
};

// Passes each warning on once, though several moments may give it. Names of moments differ by their numbers.
Notify once_for_all(const Notify &notify) {
    return [notify, told = std::make_shared<std::set<std::string>>()](const Notice &notice) {
        std::string kind = words_of(notice);
        std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) != 0; });
        if (level_of(notice) == NoticeLevel::note || told->insert(kind).second) notify(notice);
    };
}

// One moment of the shutter: its name, and how it is taken.
struct ShutterMoment {
    std::string name;
    std::function<TakenPicture(const PictureRequest &, const PictureWork &)> take;
};

class Shutter {
public:
    Shutter(std::vector<ShutterMoment> moments, const PictureRequest &request, const PictureWork &work)
        : moments_(std::move(moments)), request_(request), progress_(work.progress, moments_.size()),
          work_(work), notify_(once_for_all(work.notify)), curve_(shutter_curve(request.shutter_curve)) {}

    // The middle moment goes first, because it decides on the focus.
    TakenPicture picture() {
        const std::size_t middle = moments_.size() / 2;
        if (request_.show == Show::picture) follow_lamps(middle);
        TakenPicture out = taken(middle);
        if (request_.show != Show::picture) return out;
        request_.front_depth = false;
        focus_as(out, request_);
        const auto weights = row_weights(curve_, int(moments_.size()), request_.rolling_shutter,
                                         out.image.windows.display_height());
        mean_.add(out.image, weights[middle], true);
        for (std::size_t m = 0; m < moments_.size(); ++m)
            if (m != middle && counts(weights[m])) add(m, weights[m], moments_[middle].name, out);
        progress_.finish();
        out.image = mean_.take();
        out.header = without_stated_moment(out.header);
        return out;
    }

private:
    // All moments have the focus of the middle one.
    static void focus_as(const TakenPicture &middle, PictureRequest &request) {
        if (request.focus_pixel) request.lens.focus_distance = middle.camera.focus_distance;
        request.focus_pixel.reset();
    }

    // Finds the paths of lamps. If the middle moment has no lamps, the others are not looked at.
    void follow_lamps(std::size_t middle) {
        if (!request_.picture.method->by_lens_points) return;
        PictureRequest request = request_;
        request.front_depth = false;
        std::vector<std::vector<LampPart>> lamps(moments_.size());
        const Notify silent = [](const Notice &) {}; // each moment tells when it is taken
        const auto find = [&](std::size_t moment) {
            request.picture.gather.lens.lamps = &lamps[moment];
            return moments_[moment].take(request, {progress_.unseen(), silent, nullptr, nullptr, looks()});
        };
        focus_as(find(middle), request);
        if (lamps[middle].empty()) return;
        for (std::size_t m = 0; m < moments_.size(); ++m)
            if (m != middle) find(m);
        paths_ = find_lamp_paths(std::move(lamps));
    }

    TakenPicture taken(std::size_t moment) {
        request_.picture.gather.lens.share =
            share_of_moment(int(moment), int(moments_.size()), request_.rolling_shutter);
        request_.picture.gather.lens.paths = paths_.empty() ? nullptr : &paths_[moment];
        PictureWork work{progress_.next(), notify_, work_.device, nullptr, looks(), work_.frame};
        TakenPicture picture = moments_[moment].take(request_, work);
        require_moment({moments_[moment].name, picture}, moment, moments_.size());
        return picture;
    }

    LooksReader *looks() { return work_.looks ? work_.looks : &looks_; }

    // Whether a moment has a weight in any row.
    static bool counts(std::span<const double> weights) {
        return std::ranges::any_of(weights, [](double weight) { return weight > 0; });
    }

    void add(std::size_t moment, std::span<const double> weights, const std::string &middle,
             TakenPicture &out) {
        const TakenPicture picture = taken(moment);
        require_same_shutter({middle, out}, {moments_[moment].name, picture});
        mean_.add(picture.image, weights, false);
        out.moments += 1;
        out.samples_read += picture.samples_read;
        out.samples_invisible += picture.samples_invisible;
    }

    std::vector<ShutterMoment> moments_;
    PictureRequest request_;
    WholeProgress progress_;
    const PictureWork &work_;
    Notify notify_;
    LooksReader looks_;
    ShutterCurve curve_;
    ShutterMean mean_;
    std::vector<LampPaths> paths_; // [moment]; empty: there are no lamps
};

// The request for the files of one moment.
PictureRequest request_at(PictureRequest request, const std::string &number) {
    for (std::string *name :
         {&request.input, &request.holdout, &request.recolor, &request.depth.picture.depth_file})
        *name = at_moment(*name, number);
    return request;
}

void require_several(const PictureRequest &request, bool several) {
    if (several) return;
    const char *given = !request.shutter_curve.empty() ? "`shutter_curve`"
                        : request.rolling_shutter != 1 ? "`rolling_shutter`"
                                                       : nullptr;
    if (given)
        throw UsageError(given +
                         std::string(": needs the moments of a shutter, each an LDI (docs/motion.md)"));
}

} // namespace

TakenPicture take_moments(LdiCache &cache, bool keep, const PictureRequest &request,
                          const PictureWork &work) {
    const bool several = names_moments(request.input);
    require_several(request, several);
    if (!several) return take_picture(cache, keep, request, work);
    std::vector<ShutterMoment> moments;
    for (const std::string &number : moments_on_disk(request.input))
        moments.push_back({at_moment(request.input, number),
                           [&cache, number](const PictureRequest &all, const PictureWork &by) {
                               return take_picture(cache, false, request_at(all, number), by);
                           }});
    return Shutter(std::move(moments), request, work).picture();
}

TakenPicture take_moments(std::span<const OpenedLdi *const> ldis, const PictureRequest &request,
                          const PictureWork &work) {
    require_several(request, ldis.size() > 1);
    if (ldis.size() == 1) return take_picture(*ldis[0], request, work);
    std::vector<ShutterMoment> moments;
    for (const OpenedLdi *ldi : ldis)
        moments.push_back({ldi->name, [ldi](const PictureRequest &moment, const PictureWork &by) {
                               return take_picture(*ldi, moment, by);
                           }});
    return Shutter(std::move(moments), request, work).picture();
}

PictureRequest middle_moment(const PictureRequest &request) {
    if (!names_moments(request.input)) return request;
    const std::vector<std::string> numbers = moments_on_disk(request.input);
    return request_at(request, numbers[numbers.size() / 2]);
}

namespace {

// The focal length and the radius of a lens may change by this factor while a shutter is open, in a fast zoom.
constexpr double most_change = 1.25;

bool is_far_from(double one, double other) {
    return std::max(one, other) > most_change * std::min(one, other);
}

[[noreturn]] void refuse(const std::string &first, const std::string &other, const std::string &what) {
    throw Error(fmt::format("{}: {} than {}; the moments of a shutter are of one shot", other, what, first));
}

} // namespace

void require_same_size(const NamedWindows &first, const NamedWindows &other) {
    const Windows &size = first.windows, &others = other.windows;
    if (size.display != others.display)
        refuse(first.name, other.name, fmt::format("its size of {} is another", size_text(others.display)));
    if (size.pixel_aspect != others.pixel_aspect)
        refuse(first.name, other.name,
               fmt::format("its pixel aspect of {:g} is another", others.pixel_aspect));
}

void require_same_shutter(const NamedPicture &first, const NamedPicture &other) {
    const TakenPicture &a = first.picture, &b = other.picture;
    require_same_size({first.name, a.image.windows}, {other.name, b.image.windows});
    const auto refused = [&](const std::string &what) { refuse(first.name, other.name, what); };
    if (a.image.channels != b.image.channels) refused("it has other channels");
    if (!same_chromaticities(a.header, b.header)) refused("it is in another colour space");
    if (is_far_from(a.lens.focal_px, b.lens.focal_px))
        refused(fmt::format("its focal length of {:g} pixels is another", b.lens.focal_px));
    if (is_far_from(a.lens.radius, b.lens.radius))
        refused(fmt::format("its lens radius of {:g} is another", b.lens.radius));
}

void require_moment(const NamedPicture &one, std::size_t moment, std::size_t moments) {
    const auto stated = stated_moment(one.picture.header);
    if (!stated) return;
    if (stated->moments != int(moments))
        throw Error(
            fmt::format("{}: is one of {} moments, and there are {}", one.name, stated->moments, moments));
    if (stated->moment != int(moment))
        throw Error(fmt::format("{}: is moment {} of its shutter, and the files have it as moment {}",
                                one.name, stated->moment, moment));
}

} // namespace sparselens
