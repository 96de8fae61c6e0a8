# Files of the readers, the writer and the repair, relative to sdk/mesh.
set(QC_MESH_IO_SOURCES
    io/number.c io/text.c io/soup.c io/obj.c io/off.c io/ply_header.c io/ply.c io/stl.c io/read.c
    io/write.c)
