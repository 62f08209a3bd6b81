// Which passes run, in what order, with which barriers, and why the others do not. A pure function (DESIGN.md, section 10).
#pragma once
#include "base/result.h"
#include "plan/pass.h"

namespace tessera
{

// All accesses on one side of a barrier.
struct AccessSet
{
	uint32_t bits = 0;
	void add(Access access) { bits |= 1u << static_cast<uint32_t>(access); }
	bool has(Access access) const { return bits >> static_cast<uint32_t>(access) & 1u; }
	bool empty() const { return bits == 0; }
};

struct PlanStep
{
	const PassDesc* pass = nullptr;
	uint32_t repeat = 0;        // which repetition of the pass
	AccessSet wait_for;         // memory barrier before the step: from these earlier accesses ...
	AccessSet then;             // ... to these of the step; both empty: no barrier
	bool clears_depth = false;  // first to draw into the depth attachment
};

struct DroppedPass
{
	std::string_view name;
	std::string reason;
};

struct PlannedResource
{
	std::string_view name, kind;
	bool kept = false;
	std::string reason;   // why it is left out, or would be were it not forced
	uint64_t bytes = 0;   // held when kept, saved when not
	bool forced = false;  // kept by --force alone
};

struct FramePlan
{
	std::vector<PlanStep> steps;
	std::vector<DroppedPass> dropped;
	std::vector<DroppedPass> forced;  // passes that --force alone keeps, and why they would be left out
	std::vector<PlannedResource> resources;
	std::vector<Feature> features;

	bool has(std::string_view pass) const;
	std::string reason(std::string_view pass) const;  // why it is left out; empty when kept or unknown
	bool keeps(std::string_view resource) const;
	// Every read of something that a step writes has an earlier write and a barrier since.
	bool everyReadHasAnEarlierWriteAndABarrier(const PlanInput& input) const;
};

// Walks back from the wanted resources: a pass stays if its conditions hold and something kept reads what it writes.
// `passes` in execution order. What `input` forces is kept, too, with what it needs, and marked. Errors: DeviceCannot when a wanted resource, or a
// list or image that a kept pass reads, has no writer left, with the reasons.
Result<FramePlan> planFrame(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources,
							std::span<const std::string_view> wanted, const PlanInput& input);

// Features of the shaders for this scene and these options; nothing here depends on the view.
std::vector<Feature> shaderFeatures(const PlanInput& input);

}  // namespace tessera
