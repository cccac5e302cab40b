# Sourced by scripts/package: a static Embree for the portable wheels of a target, in $built/embree.
# Debian's own needs a newer C library; and a shared one would meet the one that Blender brings.
embree_version=3.13.5
embree_source="embree_$embree_version+dfsg.orig.tar.xz"
embree_sha256=1b7c5b6144230ad81b92ece884a2017fbbb433bf5416a6fca9257e0109501c63

# Skinglow traces rays against triangles, with occlusion filters, which Embree ignores without a word where they are not compiled in.
# SSE 4.2 is the one instruction set of all machines that Blender runs on; AVX2, which nearly all have, and AVX-512 are chosen by
# Embree itself where the processor has them, with trees of eight branches and shadow rays in packets of eight. Of AVX-512 those parts
# are named that Embree names for GCC; for clang it names a processor instead.
embree_options=(-DEMBREE_STATIC_LIB=ON -DEMBREE_TASKING_SYSTEM=INTERNAL -DEMBREE_IGNORE_CMAKE_CXX_FLAGS=OFF -DEMBREE_MAX_ISA=NONE
    -DEMBREE_ISA_SSE42=ON -DEMBREE_ISA_AVX2=ON -DEMBREE_ISA_AVX512=ON -DEMBREE_RAY_PACKETS=ON -DEMBREE_FILTER_FUNCTION=ON
    "-DFLAGS_AVX512=-mf16c -mavx2 -mfma -mlzcnt -mbmi -mbmi2 -mavx512f -mavx512dq -mavx512cd -mavx512bw -mavx512vl\
 -mprefer-vector-width=256")
for name in ISA_{SSE2,AVX} GEOMETRY_{QUAD,CURVE,SUBDIVISION,USER,INSTANCE,GRID,POINT} \
    STACK_PROTECTOR ISPC_SUPPORT TUTORIALS; do
    embree_options+=("-DEMBREE_$name=OFF")
done
embree_unused=(scene_user_geometry scene_instance scene_quad_mesh scene_curves scene_line_segments scene_grid_mesh scene_points
    rtcore_builder motion_derivative bezier_curve bspline_curve catmullrom_curve instance_intersector bvh_builder_hair
    bvh_builder_hair_mb bvh_builder_sah_mb bvh_builder_sah_spatial bvh_builder_twolevel bvh_builder_morton bvh_refit bvh_rotate
    bvh_intersector_stream_bvh4 bvh_intersector_stream_bvh8 bvh_intersector_hybrid16_bvh4 bvh_intersector_hybrid16_bvh8
    'curve_intersector_virtual_[a-z0-9_]*')

unpack_embree() {
    rm -rf "$portable/embree_source"
    mkdir -p "$portable/embree_source"
    tar -C "$portable/embree_source" --strip-components=1 --exclude='*/tutorials/*' -xJf "$portable/$embree_source"
    # What is off is compiled all the same, and takes most of the build's time; the linker says if something is missed.
    local lists=$portable/embree_source/kernels/CMakeLists.txt common=$portable/embree_source/kernels/common name
    for name in "${embree_unused[@]}"; do sed -i "s| [a-z]*/$name\.cpp||" "$lists"; done
    # Of the forms that triangles are stored in, scenes with RTC_SCENE_FLAG_ROBUST that never move have one, and of it rays singly, by
    # four and by eight are asked for: a tenth of all, of which the rest would be half of our module.
    local bvh=$portable/embree_source/kernels/bvh kept='Triangle4v\(Intersector1Pluecker\|Intersector[48]HybridPluecker\|SceneBuilderSAH\)\b'
    sed -i "/IF_ENABLED_TRIS/{/$kept/!d}" "$bvh"/bvh[48]_factory.cpp "$bvh"/bvh_intersector{1,_hybrid[48]}_bvh[48].cpp
    sed -i '/intersectors\.intersector\(16\|N\) *= BVH[48]Triangle4v/d; /SELECT_SYMBOL.*StreamPacketFallback/d' "$bvh"/bvh[48]_factory.cpp
    sed -i '/Builder\* BVH[48].*\(Quantized\|Triangle4[^v]\|MeshBuilder\)/d' "$bvh/bvh_builder_sah.cpp"
    # What AVX without AVX2 would bring comes with AVX2 instead: a third copy of everything for processors of 2011 and 2012.
    sed -i 's/EQUAL \${ISA_LOWEST_AVX}/EQUAL ${AVX2}/; s/IF (\${ISA} EQUAL \${AVX})/IF (${ISA} EQUAL ${AVX2})/' "$lists"
    sed -i 's/defined(EMBREE_TARGET_AVX) ||/defined(EMBREE_TARGET_AVX2) ||/
        s/(features & AVX) == AVX) intersector = avx::/(features \& AVX2) == AVX2) intersector = avx2::/' "$common/isa.h"
    sed -i 's/hasISA(AVX)/hasISA(AVX2)/' "$common/state.h" "$common/device.cpp"
    # And the lowest instruction set would be compiled twice.
    sed -i 's/IF (EMBREE_ISA_SSE42 AND .*/IF (FALSE)/' "$lists"
    sed -i '/embree_sse42-targets/d' "$portable/embree_source/common/cmake/embree-config.cmake"
    # A static library has no use for the version that Windows shows of a DLL.
    sed -i '/embree\.rc/d' "$lists"
    # Two output operators that nobody calls name members that are not there, which Clang tells since version 19.
    sed -i 's/(" << a\.u\.lower << ", " << a\.u\.upper << "), " <</" <</' "$portable/embree_source/kernels/subdiv/bezier_curve.h"
    sed -i 's/ << line\.v0 << ", " <</ <</' "$portable/embree_source/kernels/geometry/pointi.h"
}

build_embree() {
    local want
    want=$({ cat "$steps/embree.sh" "$toolchain" "$portable/tools/requirements"; echo "${embree_more[@]}"; } | sha256sum)
    [ "$(cat "$built/embree/digest" 2>/dev/null)" != "$want" ] || return 0
    fetch_source libembree-dev "$embree_source" "$embree_sha256"
    say "building Embree $embree_version for $target"
    unpack_embree
    rm -rf "$built/embree_build" "$built/embree"
    {
        cmake -G Ninja -S "$portable/embree_source" -B "$built/embree_build" -DCMAKE_BUILD_TYPE=Release \
            -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCMAKE_INSTALL_PREFIX="$built/embree" "${embree_options[@]}" \
            "${embree_more[@]}" &&
            cmake --build "$built/embree_build" && cmake --install "$built/embree_build" --component devel
    } >"$built/embree.log" 2>&1 ||
        { tail -n 20 "$built/embree.log" >&2; fail "Embree did not build; the whole log: $built/embree.log"; }
    printf '%s' "$want" >"$built/embree/digest"
}
