"""The compliance in a fraction of its memory: uniform block low rank with adaptive precision.

Far parts of a body see each other only through a few smooth patterns. So the free surface nodes are
put into clusters, each cluster gets one orthonormal basis of the displacements that other clusters
cause in it, and a block between two clusters becomes a small matrix between their bases, stored in
as many bits as the tolerance asks for. Blocks between neighbours stay whole.

    column_source.py         who can give exact columns of L
    clusters.py              nodes -> clusters, and which clusters are neighbours
    cluster_columns.py       exact columns of one cluster -> near blocks, basis, projection
    coupling.py              projections -> couplings between bases, and the error so far
    tiles.py                 couplings -> numbers of 8 and 16 bits, and the error that makes
    compress.py              all of it, one pass over the columns
    compressed_compliance.py the result: blocks, columns, displacements
"""
