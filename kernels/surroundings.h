/* What acts on every node besides springs, in the common subset of C++ and OpenCL C. */
struct Surroundings {
  float viscous_damping; /* 1/s */
  float gravity;         /* m/s^2, downwards */
  float floor_height;    /* m */
  float restitution;
  float friction;
};
