#!/bin/bash
# The effect for OpenFX in hostDemo, the host of the OpenFX SDK, as a generator and a filter. Not one of ctest's tests, because
# no package of Debian has the SDK: its source is in the crate openfx-sys 0.1.0. Needs libexpat1-dev.
#   bash hostdemo.sh BIN_DIR FILE.ofx SDK     SDK: the folder `openfx` of the crate, with HostSupport and include
# hostDemo asks for one effect in one context and gives all its numbers the value 2, so a copy of it is changed: the name of
# the effect, the context, texts, and values from the environment (OFX_focus_distance), else the defaults.
. "$(dirname "$0")/../tools/check.sh"
effect=$(realpath "$2") sdk=$(cd "$3" && pwd)
[ -s /usr/include/expat.h ] || skip "hostDemo needs libexpat1-dev"

cp -r "$sdk/HostSupport" "$sdk/include" .
cd HostSupport/examples
cat >text_parameter.h <<'END'
#include <cstdlib>
namespace MyHost {
class MyTextInstance : public OFX::Host::Param::StringInstance {
    std::string name_;
    OfxStatus get(std::string &text) override {
        const char *given = std::getenv(("OFX_" + name_).c_str());
        text = given ? given : "";
        return kOfxStatOK;
    }
    OfxStatus get(OfxTime, std::string &text) override { return get(text); }
    OfxStatus set(const char *) override { return kOfxStatErrMissingHostFeature; }
    OfxStatus set(OfxTime, const char *) override { return kOfxStatErrMissingHostFeature; }
public:
    MyTextInstance(const std::string &name, OFX::Host::Param::Descriptor &descriptor) : StringInstance(descriptor), name_(name) {}
};
}
END
sed -i 's/net.sf.openfx:invertPlugin/org.sparselens.DepthOfField/; s/kOfxImageEffectContextFilter, NULL/argv[1], NULL/' hostDemo.cpp
sed -i 's|d = 2.0;|const char *given = getenv(("OFX_" + getName()).c_str());\n    d = given ? atof(given) : getProperties().getDoubleProperty(kOfxParamPropDefault);|; s/b = true;/b = false;/' hostDemoParamInstance.cpp
sed -i 's|#include "hostDemoParamInstance.h"|&\n#include "text_parameter.h"|; s|if(descriptor.getType()==kOfxParamTypeInteger)|if(descriptor.getType()==kOfxParamTypeString)\n      return new MyTextInstance(name,descriptor);\n    else &|' hostDemoEffectInstance.cpp
sed -i 's|// data ptr|setStringProperty(kOfxImageEffectPropPixelDepth, kOfxBitDepthByte);|' hostDemoClipInstance.cpp # as its memory is
g++ -std=gnu++14 -w -include cstring -I../include -I../../include hostDemo*.cpp ../src/*.cpp -o "$scratch/hostDemo" -lexpat -ldl -pthread || fail "hostDemo is not built"
cd "$scratch"

# Bottom to top, as hostDemo writes it.
picture make flat.exr 720x576 R=0..1 G=1..0 B=0.25 A=1 Z=4 fill=200x100+300+60 R=0.75 G=0.1 Z=2
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.02)
exits 0 "$bin/ldi-warp" flat.exr "${lens[@]}" --focus-distance 2 -o shot.ldi.exr
exits 0 "$bin/dof-gather" shot.ldi.exr -o expected.png --focus-distance 4
export OFX_PLUGIN_PATH OFX_ldi=$scratch/shot.ldi.exr OFX_focus_distance=4
OFX_PLUGIN_PATH=${effect%/*.ofx.bundle/*}
export SPARSELENS_BIN=$bin
for context in OfxImageEffectContextGenerator OfxImageEffectContextFilter; do
    rm -f Output.*.ppm hostDemoPluginCache.xml
    exits 0 timeout 300 ./hostDemo $context
    [ -s Output.1.ppm ] || fail "$context: no picture ($(tail -n 3 stdout stderr))"
    for frame in 0 1; do
        oiiotool --flip Output.$frame.ppm expected.png --fail 0.0041 --failpercent 0 --hardfail 0.0041 --diff >log 2>&1 ||
            fail "$context: frame $frame is another picture ($(cat log))"
    done
done

# A flat source with its depth: hostDemo's clip is grey, of frame 1 white, and so is its depth of 1 unit.
unset OFX_ldi
export OFX_focal_length=50 OFX_sensor_width=36 OFX_lens_radius=0
rm -f Output.*.ppm
exits 0 timeout 300 ./hostDemo OfxImageEffectContextFilter
[ -s Output.1.ppm ] || fail "a flat source: no picture ($(tail -n 3 stdout stderr))"
awk 'NR > 4 && NF == 3 { all += $1 + $2 + $3; ++n } END { exit !(n == 720 * 576 && all / n / 3 > 200) }' Output.1.ppm || fail "the flat source has changed"
echo "hostdemo: fine"
