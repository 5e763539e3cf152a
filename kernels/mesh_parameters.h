/* How the work-items of a mesh's stage kernels share it, in the common subset of C++ and OpenCL C. */
struct MeshParameters {
  unsigned tiles; /* of MSSIM_LANES nodes each */
  unsigned tiles_per_item;
};
