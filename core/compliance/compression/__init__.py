"""The compliance in a fraction of its memory: uniform block low rank with adaptive precision.

Far parts of a body act on each other through a few smooth patterns. The free surface nodes are put
into clusters, each with one orthonormal basis of the displacements that other clusters cause in it;
a block between two clusters becomes a small matrix between their bases, the interaction, in as many
bits as the tolerance asks for. Blocks between neighbours are stored in full.

    column_source.py         exact columns of L
    clusters.py              nodes -> clusters, and their neighbours
    cluster_columns.py       exact columns of one cluster -> near blocks, basis, projection
    interactions.py        projections -> interactions between bases, and the error of cutting
    tiles.py                 interactions -> numbers of 8 and 16 bits, and the error of rounding
    compress.py              all of it, one pass over the columns
    compressed_arrays.py     the arrays that come of it
    compressed_compliance.py the result: blocks, columns, displacements
"""
