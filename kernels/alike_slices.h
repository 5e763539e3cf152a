/* Slices of alike bodies (AlikeSlices in src/backends/layouts): one node of MSSIM_SLICE bodies, x y z u v w
 * of all of them one after the other. Needs lanes.h, and MSSIM_SLICE, a multiple of MSSIM_LANES.
 */
#define slice_floats (6 * MSSIM_SLICE)
