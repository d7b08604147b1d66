// Makes one LDI with fewer samples from deep pictures: merges them by depth, takes colours from a flat picture, and
// clusters.
#pragma once

#include "chain/flat_light.h"
#include "deep/cluster.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct ClusterRequest {
    std::vector<std::string> inputs = {}, depth_files = {}; // files; the latter one per input or none
    std::string recolor = {};                               // a flat picture with their colours; or empty
    DepthOptions depth = {};
    ColourOptions colour = {};        // how the flat picture's colours are read
    const FlatFile *beauty = nullptr; // the same picture in memory, with linear colours
    LensValues lens = {};             // override the files' values
    std::optional<int> supersample = {};
    std::optional<double> tolerance = {}; // pixels of CoC; default 0.25 if the lens is known
    int layers = 0;                       // see ClusterOptions
};

struct ClusteredLdi : Clustered {
    Imf::Header header = {};
    Camera camera = {};
    std::size_t samples_read = 0, invisible = 0; // see OpenedLdi
};

// Takes the files of the request, or LDIs in memory. Name, header and camera are those of the first. Throws Error,
// naming the file, if its display window, its sub-pixels or its focal length differ from those of the first.
ClusteredLdi cluster_ldi(const ClusterRequest &request, Progress &progress, const Tell &tell);
ClusteredLdi cluster_ldi(std::span<const OpenedLdi *const> ldis, const ClusterRequest &request,
                         Progress &progress, const Tell &tell);

} // namespace sparselens
