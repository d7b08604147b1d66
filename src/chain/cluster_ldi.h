// Makes one LDI of deep pictures, of fewer samples: merges them by depth, gives them the colours of a flat picture, and clusters.
#pragma once

#include "chain/recolor_ldi.h"
#include "deep/cluster.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct ClusterRequest {
    std::vector<std::string> inputs = {}, depth_files = {}; // files; the latter of each, or none
    std::string recolor = {};                               // the flat picture of their colours; empty: none
    DepthOptions depth = {};
    ColourOptions colour = {};        // of the flat picture
    const FlatFile *beauty = nullptr; // the same picture in memory, of linear colours
    LensValues lens = {};             // over what the files say
    std::optional<int> supersample = {};
    std::optional<double> tolerance = {}; // pixels of CoC; else 0.25, if the lens is known
    int layers = 0;                       // see ClusterOptions
};

struct ClusteredLdi : Clustered {
    Imf::Header header = {};
    Camera camera = {};
    std::size_t samples_read = 0, invisible = 0; // see OpenedLdi
};

// Takes the files of the request, or LDIs in memory. Name, header and camera are those of the first. Throws Error, naming the file, if
// its display window, its sub-pixels or its focal length differ from those of the first.
ClusteredLdi cluster_ldi(const ClusterRequest &request, Progress &progress, const Tell &tell);
ClusteredLdi cluster_ldi(std::span<const OpenedLdi *const> ldis, const ClusterRequest &request,
                         Progress &progress, const Tell &tell);

} // namespace sparselens
