#include "pipeline/passes.h"

namespace tessera
{

std::span<const PassDesc* const> framePasses()
{
	static constexpr const PassDesc* kPasses[] = {
		&kFrameBegin,  &kInstanceClassify, &kClusterCull, &kClusterClassify, &kTriangleSplit, &kRateSearch,     &kBatchParts,
		&kRateFit,     &kEvaluateVertices, &kRasterMicro, &kDepthPyramid,    &kRetestParts,   &kRasterRevealed, &kDrawClusters,
		&kDrawBatches, &kDrawIndexed,      &kDumpMicro,   &kKeepVisibility,  &kShade,
	};
	return kPasses;
}

}  // namespace tessera
