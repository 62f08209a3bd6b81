// What a ray met, for tests of the cluster layer. A ray that meets nothing has t below 0.
struct Hit
{
	float t;
	float u;
	float v;
	uint cluster;
	uint geometry;
	uint primitive;
	uint custom;
	uint instance;
};
