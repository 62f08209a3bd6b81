// Arguments of the two passes that batch parts: batch_parts and, for what it left out as hidden, retest_parts.
#pragma once
#include "pipeline/uses.h"
#include "plan/conditions.h"
#include "tessellation/batch_parts.h"

namespace tessera
{

inline BatchPartsArgs batchPartsArgs(const PassContext& pass)
{
	BatchPartsArgs args = {};
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.part_triangles = pass.address("part_triangles");
	args.patterns = pass.address("patterns");
	args.batches = pass.address("batches");
	args.part_places = pass.address("part_places");
	args.window_seen = pass.address("window_seen");
	if (kClusterParts.holds(pass.input()))
		args.window_vertices = pass.address("window_vertices");
	args.instances = pass.address("instances");
	args.clusters = pass.address("clusters");
	args.cluster_bounds = pass.address("cluster_bounds");
	args.triangle_reaches = pass.address("triangle_reaches");
	args.visible_clusters = pass.address("visible_clusters");
	const bool for_compute = kBuffered.holds(pass.input());
	args.most_parts = for_compute ? RASTER_BATCH_PARTS : BATCH_MAX_PARTS;
	args.most_vertices = for_compute ? RASTER_BATCH_VERTICES : BATCH_MAX_VERTICES;
	args.most_triangles = for_compute ? RASTER_BATCH_TRIANGLES : BATCH_MAX_TRIANGLES;
	return args;
}

}  // namespace tessera
