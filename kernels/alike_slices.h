/* Slices of alike bodies (AlikeSlices in src/backends/layouts): one node of MSSIM_SLICE bodies, its x of all
 * bodies, then y, z, u, v and w. Needs lanes.h, and MSSIM_SLICE, a multiple of MSSIM_LANES.
 */
#define slice_floats (6 * MSSIM_SLICE)
