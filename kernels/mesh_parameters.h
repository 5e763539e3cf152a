/* How the work-items of a mesh's stage kernels share it, in the common subset of C++ and OpenCL C. */
struct MeshParameters {
  unsigned sites; /* of MSSIM_LANES nodes each */
  unsigned sites_per_item;
};
