#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include "core/flow/stokes.h"
#include "core/io/medit.h"
#include "core/mesh/sample_meshes.h"
using namespace lamella;
double now(){return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();}
template<int D> void name_faces(SimplexMesh<D>& m, const char* left="gate", const char* right="vent", std::vector<int> sym={}){
  m.groups={"walls",left,right,"symmetry"};
  for(size_t f=0;f<m.facets.size();++f){int c=m.facet_face[f]; m.facet_group[f]= c==0?1:c==1?2:0; for(int s:sym) if(c==s) m.facet_group[f]=3;}
}
template<int D> Flow<D> go(const SimplexMesh<D>& m,const FlowCase<D>& c,const char* what){
  double t=now();
  auto r=solve_stokes<D>(m,c,{});
  t=now()-t;
  if(!r){printf("%s: %s %s\n",what,r.error().message.c_str(),r.error().hint.c_str());return {};}
  printf("%-30s nodes %8zu it %4zu res %.1e imbalance %.1e time %.2f",what,m.node_count(),r->residuals.size()-1,r->residuals.back(),r->imbalance,t);
  for(auto&o:r->openings)printf("  %s p %.4g q %.6g a %.4g",o.group.c_str(),o.pressure,o.rate,o.area);
  printf("\n");fflush(stdout);
  return std::move(*r);
}
int main(int argc,char**argv){
  std::string w=argc>1?argv[1]:"";
  if(w=="p2"){ // planar Poiseuille: L x 1, cells
    int L=atoi(argv[2]); double ar=atof(argv[3]);
    for(int n:{4,8,16,32,64}){
      auto m=box_mesh<2>({std::max(1,(int)(L*n/ar)),n},{0,0},{(double)L,1});
      name_faces<2>(m);
      FlowCase<2> c; c.gates={{"gate",1.0,{}}}; c.vents={"vent"};
      char t[100]; snprintf(t,100,"L %d ar %g n %d",L,ar,n);
      auto f=go<2>(m,c,t);
      double ev=0,ep=0,vm=1./(8*L);
      if(f.velocity.empty()) continue;
      for(size_t i=1;i<m.points.size();++i){auto x=m.points[i]; Vec<2> v(x[1]*(1-x[1])/(2*L),0); ev=std::max(ev,(f.velocity[i]-v).norm()); ep=std::max(ep,std::abs(f.pressure[i]-(1-x[0]/L)));}
      printf("   ev %.3e ep %.3e\n",ev/vm,ep);
    }
  }
  if(w=="p3"){ int L=atoi(argv[2]); double W=atof(argv[3]); double ar=atof(argv[4]);
    for(int k=5;k<argc;++k){int n=atoi(argv[k]);
      auto m=box_mesh<3>({std::max(1,(int)(L*n/ar)),std::max(1,(int)(W*n/ar)),n},{0,0,0},{(double)L,W,1});
      name_faces<3>(m);
      FlowCase<3> c; c.gates={{"gate",1.0,{}}}; c.vents={"vent"};
      char t[100]; snprintf(t,100,"L %d W %g ar %g n %d",L,W,ar,n);
      go<3>(m,c,t);
    }
  }
  if(w=="mesh"){
    auto r=read_medit<3>(argv[2]); if(!r){puts(r.error().message.c_str());return 1;}
    auto& m=*r; Vec<3> lo=Vec<3>::Constant(1e300),hi=-lo; for(size_t i=1;i<m.points.size();++i){lo=lo.cwiseMin(m.points[i]);hi=hi.cwiseMax(m.points[i]);}
    int ax=atoi(argv[3]); double s=atof(argv[4]); (void)s;
    m.groups={"walls","gate","vent"};
    for(size_t f=0;f<m.facets.size();++f){double a=1e300,b=-1e300;for(int v:m.facets[f]){a=std::min(a,m.points[v][ax]);b=std::max(b,m.points[v][ax]);} double d=(hi-lo)[ax]*s; m.facet_group[f]=b<lo[ax]+d?1:a>hi[ax]-d?2:0;}
    FlowCase<3> c; c.gates={{"gate",1.0,{}}}; c.vents={"vent"};
    go<3>(m,c,argv[2]);
  }
}
