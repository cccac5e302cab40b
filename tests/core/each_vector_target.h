#pragma once

#include "numerics/vector_targets.h"
// Before Highway's headers.
#include <gtest/gtest.h>
#include <hwy/targets.h>

/// Does the work with each instruction set that is compiled and that this processor has.
template <class Work>
void for_each_vector_target(const Work& work) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        SCOPED_TRACE(hwy::TargetName(target));
        work();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}
