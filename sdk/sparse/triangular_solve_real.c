/* triangular_solve.c for real matrices. */
#define QC__REAL
#include "sdk/sparse/triangular_solve.c"
