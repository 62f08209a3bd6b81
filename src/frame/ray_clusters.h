// What a frame's rays are traced through where the device builds from clusters: templates made once; per frame clusters made from them or from
// triangles, and one bottom-level structure per instance of the scene. Memory follows the demand as that of ray_structures.h does.
#pragma once
#include "frame/cluster_reserve.h"
#include "frame/cluster_templates.h"
#include "frame/stats.h"
#include "plan/plan.h"

#include <optional>

namespace tessera
{

class RayClusters
{
public:
	explicit RayClusters(Device& device) : device_(device) {}

	// Makes ready for a frame that is not drawn yet; templates when there are none of these options. `positions`: address of the scene's vertices.
	// Errors: BadInput (out of memory).
	Status prepare(const BuiltScene& scene, const TessellationTable& table, const PlanInput& input, uint64_t positions, CommandRecorder& commands);
	// Lets go of everything.
	void drop();
	bool exists() const { return bool(work_); }

	// Address of ClusterWork, and what of it traces need.
	uint64_t work() const { return work_.address(); }
	uint64_t payloads() const { return record_.payloads; }
	// Most clusters of the frame, and instances of the scene: what passes loop over.
	uint32_t mostClusters() const;
	uint32_t sceneInstances() const { return record_.scene_instances; }

	void recordInstantiations(VkCommandBuffer commands) const;
	void recordTransients(VkCommandBuffer commands) const;
	void recordStructures(VkCommandBuffer commands) const;

	// Copies the counts of a round to the host; readable after that was waited for.
	void recordCountsReadback(VkCommandBuffer commands) const;
	ClusterCounts counts() const;
	// From those counts; as ClusterReserve::isTooSmallFor.
	bool isTooSmall(bool fits);
	// What a frame wanted of the memory for clusters over what it may have: above 1 no reservation helps.
	double dataOverload(const PlanInput& input) const;

	uint64_t bytes() const;
	// Into what is said of rays. `generated_vertices`: micro-vertices of the frame.
	void addStats(RayStats& stats, uint32_t generated_vertices) const;

private:
	ReserveCounts firstReserve(const PlanInput& input) const;
	ReserveCounts mostReserve(const PlanInput& input) const;
	Status makeTemplates(const BuiltScene& scene, const TessellationTable& table, const TemplateOptions& options, CommandRecorder& commands);
	Status makeTransientUnits(CommandRecorder& commands);
	void describeBuilds(const PlanInput& input);
	Status makeMemory();
	Status makeScratch();
	void placeInputs();
	void placeLists();
	ClusterBuild transientOf(uint32_t triangles) const;
	ClusterBuildAddresses addresses(uint64_t infos, uint64_t count, uint64_t destinations) const;

	Device& device_;
	std::optional<TemplateOptions> template_options_;
	std::optional<BuildPreference> transient_build_;
	ClusterTemplates templates_;
	ClusterReserve reserve_;
	ClusterBuild instantiations_, transients_, structures_;
	ClusterWork record_ = {};
	ClusterWork uploaded_ = {};
	// Memory of inputs is that of the bottom-level structures once clusters are built.
	Buffer transient_units_, data_, inputs_, lists_, instances_, counts_, scratch_, work_, readback_;
	uint64_t structure_bytes_ = 0;  // that the driver asks for
	uint64_t input_bytes_ = 0, lists_bytes_ = 0;
};

}  // namespace tessera
