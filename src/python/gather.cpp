#include "chain/take_moments.h"
#include "python/job.h"
#include "python/keywords.h"
#include "python/told.h"
#include "python/verbs.h"

namespace sparselens::python {

namespace {

// The request that the keywords make.
struct Asked : PictureRequest {
    py::object keep_holdout = {}, progress = {}; // the former keeps `opened_holdout` alive
};

Asked asked_by(const py::kwargs &given) {
    Keywords keywords("gather", given);
    Asked asked;
    asked.keep_holdout = keywords.take("holdout");
    if (!asked.keep_holdout.is_none())
        asked.opened_holdout = &argument<OpenedLdi>(asked.keep_holdout, "holdout", "an Ldi");
    keywords.parameters<PictureRequest>(gather_parameters(), asked);
    keywords.parameters(look_parameters(), asked.looks);
    keywords.parameters(window_parameters(), asked.windows);
    asked.lens = lens_values(keywords);
    asked.progress = keywords.take("progress");
    keywords.done();
    check_method(asked, [&](const std::string &parameter) { return keywords.is_given(parameter); });
    return asked;
}

} // namespace

PictureObject gather(const py::object &ldi, const py::kwargs &given) {
    const Asked asked = asked_by(given);
    const std::vector<const OpenedLdi *> in =
        several<OpenedLdi>(ldi, "ldi", "an Ldi, or a sequence of the moments of a shutter");
    return told_job<PictureObject>(
        asked.progress, [&](Progress &progress, const Tell &tell) -> PictureObject {
            TakenPicture made = take_moments(in, asked, {progress, tell, &gather_device()});
            return {std::move(made.image), std::move(made.header)};
        });
}

} // namespace sparselens::python
