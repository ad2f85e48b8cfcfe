"""The errors of `assets`, drawn as a tree.

AssetError
├── SiteError         a site folder that cannot be used; the command line prints it and exits 2
├── GraphicsMissing   no off-screen OpenGL on this machine; the command line prints it and exits 3
└── PackerMissing     no Node.js, or not the packages that models are packed with; exits 3, too
"""


class AssetError(Exception):
    """Root of everything that `assets` raises on purpose. The message is one sentence: the thing, and the remedy."""

    exit_code = 2


class SiteError(AssetError):
    """A site's data are missing or broken."""


class GraphicsMissing(AssetError):
    """The machine cannot draw off-screen."""

    exit_code = 3


class PackerMissing(AssetError):
    """The machine cannot pack models."""

    exit_code = 3
