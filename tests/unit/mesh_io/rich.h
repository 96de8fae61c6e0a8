/* A PLY file with everything in it: polygons of three and four corners, numbers of all kinds at
 * vertices, faces and corners, uvs with a seam, groups with names, feature edges. */
#ifndef QC_TESTS_MESH_IO_RICH_H
#define QC_TESTS_MESH_IO_RICH_H

static const char RICH_PLY[] =
    "ply\nformat ascii 1.0\ncomment made by hand\ncomment group 1 g a\ncomment group 2 g b\n"
    "comment group 2 usemtl red paint\ncomment mtllib a b.mtl\nelement vertex 6\n"
    "property float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
    "property float weight_0\nproperty float weight_1\nproperty float weight_2\n"
    "property short bone\nproperty float quality\nproperty list uchar int ignored\n"
    "element face 4\nproperty list uchar int vertex_indices\n"
    "property list uchar float texcoord\nproperty list uchar float normal\n"
    "property int group\nproperty int label\nproperty double heat\n"
    "element edge 2\nproperty int vertex1\nproperty int vertex2\n"
    "element other 1\nproperty uchar q\nend_header\n"
    "0 0 0  0 0 1    0 0 0 255     0.5 0.25 0.25    -3 1   2 5 6\n"
    "1 0 0  0 0 1    255 0 0 51    0.75 0.125 0.125  4 2   0\n"
    "1 1 0  0 0 1    0 255 0 255   1 0 0             5 nan 0\n"
    "0 1 0  0 0 1    0 0 255 255   0 1 0             6 4   0\n"
    "2 0 0  0.6 0 0.8  9 8 7 6     0 0 1             7 5   1 3\n"
    "2 1 0  0.6 0 0.8  1 2 3 4     0.5 0 0.5         12 6  0\n"
    "4 0 1 2 3  8 0 0 1 0 1 1 0 1  12 0 0 1 0 0 1 0 0 1 0 0 1  1 7 0.1\n"
    "3 1 4 5    6 9 0 2 0 3 3      9 0 -1 0 0 -1 0 0 -1 0       2 8 -1e9\n"
    "3 1 5 2    0                  9 0 0 1 0 0 1 1 0 0          2 9 3\n"
    "3 0 3 2    6 0 0 0 1 1 1      9 1 0 0 1 0 0 1 0 0          1 9 3\n"
    "0 1\n5 2\n200\n";

#endif
