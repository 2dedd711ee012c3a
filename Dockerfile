# Image of the program and the Python package on Debian 12.
#   docker build -t waymark .
#   docker run --rm -v "$PWD:/work" waymark peaks dem.tif -o tops.gpkg
FROM debian:12-slim AS build
WORKDIR /source
COPY scripts/install-packages scripts/
RUN scripts/install-packages build libraries python packaging
COPY . .
RUN scripts/make-packages /packages

FROM debian:12-slim
COPY --from=build /packages/waymark_*.deb /packages/python3-waymark_*.deb /packages/
RUN apt-get update \
 && apt-get install -y --no-install-recommends /packages/*.deb \
 && rm -rf /packages /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["waymark"]
CMD ["--help"]
