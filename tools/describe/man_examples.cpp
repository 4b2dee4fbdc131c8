#include "tools/describe/man_examples.h"

namespace weir {
namespace {

constexpr ManExample kManExamples[] = {
    {"weir", "Make a volume, convert it, check the result and look at it:",
     "weir sample cloud --dims 128,128,128 -o cloud_128x128x128_float32.raw\n"
     "weir convert cloud_128x128x128_float32.raw -o cloud.nvdb\n"
     "weir verify cloud.nvdb\n"
     "weir render cloud.nvdb -o cloud.png"},
    {"verify", "Check a file against its sidecar:", "weir verify cloud.nvdb"},
    {"inspect", "What a file holds, and what its conversion lost:", "weir inspect cloud.nvdb"},
    {"inspect", "The datasets of a source:", "weir inspect plume.h5"},
    {"convert",
     "A file of exactly 64 MiB:", "weir convert plume.h5 --dataset /fields/density --size 64MiB -o plume.nvdb"},
    {"convert", "As few bytes as keep every voxel within 0.01 of its value:",
     "weir convert v_256x256x256_float32.raw --max-error 0.01"},
    {"convert", "The steps of a series, files of one size:", "weir convert 'run_%04d.raw' --rate 8 -o nvdb/"},
    {"render", "A picture by path tracing:", "weir render cloud.nvdb -o cloud.png --mode path --spp 64"},
    {"play", "Pictures of all steps:", "weir play 'nvdb/run_*.nvdb' -o frames"},
    {"view", "Turn it in a browser:", "weir view cloud.nvdb"},
    {"sample", "A synthetic volume to try things with:",
     "weir sample turbulence --dims 256,256,256 -o t_256x256x256_float32.raw"},
    {"compare",
     "The exact error of a file against its source:", "weir compare cloud_128x128x128_float32.raw cloud.nvdb"},
    {"flip", "How much two pictures differ to the eye:", "weir flip reference.png cloud.png"},
    {"export", "A file for Blender, Houdini or ParaView:", "weir export cloud.nvdb -o cloud.vdb"},
    {"sweep", "Error and size at several rates, as a table and a plot:",
     "weir sweep cloud_128x128x128_float32.raw --rates 20,10,8,4 -o sweep"},
    {"watch", "See whether a configuration is right and its directories can be written to, as the service's user:",
     "sudo -u weir STATE_DIRECTORY=/var/lib/weir/run42 weir watch --check /etc/weir/run42.toml"},
    {"watch", "Convert what appears, in the foreground:", "weir watch weir.toml"},
    {"jobs", "What failed, and why:", "weir jobs --state failed"},
    {"jobs", "Of a service with an address or token of its own:", "weir jobs --config /etc/weir/run42.toml"},
    {"status", "How the service of a configuration is:", "weir status --config /etc/weir/run42.toml"},
    {"retry", "Try all failed and quarantined jobs again:", "weir retry --all-failed"},
    {"retry", "Convert one again although it is done:", "weir retry 17 --force"},
    {"cancel", "Give two jobs up:", "weir cancel 17 18"},
    {"pause", "Keep the disks free for an hour:", "weir pause && sleep 3600 && weir resume"},
    {"resume", "Go on after a pause:", "weir resume"},
    {"completion", "For this shell:", "source <(weir completion bash)"},
};

}  // namespace

std::span<const ManExample> man_examples() { return kManExamples; }

}  // namespace weir
