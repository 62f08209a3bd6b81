// How far two pictures are apart.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessera::report
{

// sRGB, 8 bits, 4 channels (the last is not looked at), rows top to bottom.
struct Picture
{
	uint32_t width = 0, height = 0;
	std::vector<uint8_t> rgba;
	std::vector<bool> covered;  // per pixel: something is drawn there; empty when not known
};

struct ImageError
{
	std::optional<double> psnr_db;   // none: the pictures are equal
	double ssim = 1;                 // -1..1, 1: equal
	std::optional<double> ms_ssim;   // none: a side is below 176 pixels, too small for its five scales
	uint64_t differing_pixels = 0;   // in any bit of red, green or blue
	uint64_t silhouette_pixels = 0;  // covered in one picture, background in the other
	uint64_t covered_pixels = 0;     // of the reference
};

// Both of one size. PSNR over red, green and blue as stored (peak 255).
// SSIM: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on
// Image Processing 13(4), 2004: on luma (BT.601 weights), Gaussian window of 11 x 11 with deviation 1.5, K1 = 0.01, K2 = 0.03, mean over all
// places where the window fits (the whole picture as one window when a side is below 11).
// MS-SSIM: Wang, Simoncelli, Bovik, "Multiscale Structural Similarity for Image Quality Assessment", Asilomar 2003: five scales, their weights.
ImageError compareImages(const Picture& picture, const Picture& reference);

}  // namespace tessera::report
